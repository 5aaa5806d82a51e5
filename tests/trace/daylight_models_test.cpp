// Daylight in the path tracer: what the rendered dome and the sun's disc send is what their formulas say.
#include <fmt/format.h>

#include "convert/pack.h"
#include "scene_building.h"
#include "shading/cie_sky.h"
#include "shading/daylight.h"
#include "shading/light.h"
#include "shading/sky.h"

namespace heliodon::tests {
namespace {

Sky daylight(SkyModel model, float elevation_deg, bool disc) {
    Sky sky;
    sky.model = model;
    sky.sun_azimuth_rad = 0.9f;
    sky.sun_elevation_rad = glm::radians(elevation_deg);
    sky.north_rad = 0.3f;
    sky.sun_disc = disc;
    return sky;
}

shading::Sunlight sunlight(const Sky& sky) {
    return shading::sunlight(sky.model == SkyModel::hosek ? shading::sky_model_hosek : shading::sky_model_preetham, sky.turbidity,
                             sky.sun_elevation_rad, sky.sun_angular_diameter_rad);
}

TEST(DaylightModels, OpenGroundReceivesTheIntegralOfTheDomeAndTheSunsDisc) {
    for (const SkyModel model : {SkyModel::hosek, SkyModel::preetham})
        for (const float elevation : {-9.0f, -1.0f, 0.0f, 2.0f, 10.0f, 30.0f, 60.0f, 89.0f})
            for (const bool disc : {false, true}) {
                Scene scene;
                const Sky sky = daylight(model, elevation, disc);
                scene.set_sky(sky);
                add_lux(scene, {0, 0, 0}, {0, 1, 0});
                add_lux(scene, {0, 0, 0}, {0, -1, 0});
                const auto sun = convert::pack_sun(sky);
                EXPECT_EQ(sun.has_value(), disc && elevation > -0.265f);
                const double direct = sun ? luminance(sunlight(sky).level()) : 0;
                const double expected = shading::horizontal_illuminance(convert::pack_sky(scene)) + direct;
                const auto readings = measure(scene, 1 << 13, 1);
                const std::string what = fmt::format("{} at {}°, disc {}", model == SkyModel::hosek ? "hosek" : "preetham", elevation, disc);
                EXPECT_NEAR(readings[0].value, expected, 0.005 * expected) << what;
                EXPECT_NEAR(readings[1].value, 0.2 * expected, 0.001 * expected) << what << ": the ground shines up evenly";
            }
}

TEST(DaylightModels, TheSunsDiscIsSeenWithItsLuminance) {
    Scene scene;
    const Sky sky = daylight(SkyModel::hosek, 40, true);
    scene.set_sky(sky);
    const glm::vec3 middle = shading::direction_from_azimuth(sky.sun_azimuth_rad, sky.sun_elevation_rad, sky.north_rad);
    const glm::vec3 limb = shading::direction_from_azimuth(sky.sun_azimuth_rad, sky.sun_elevation_rad + glm::radians(0.25f), sky.north_rad);
    const glm::vec3 beside = shading::direction_from_azimuth(sky.sun_azimuth_rad, sky.sun_elevation_rad + glm::radians(0.3f), sky.north_rad);
    for (const glm::vec3 direction : {middle, limb, beside}) add_sensor(scene, SensorType::luminance, {0, 0, 0}, direction);
    const auto readings = measure(scene, 16, 1);
    const shading::SkyData dome = convert::pack_sky(scene);
    const shading::LightData sun = *convert::pack_sun(sky);
    const auto expected = [&](const glm::vec3& direction, bool disc) {
        const double sky_nits = luminance(glm::dvec3(shading::sky_radiance(dome, direction, glm::vec3(1))));
        return sky_nits + (disc ? luminance(glm::dvec3(shading::light_radiance(sun, direction))) : 0.0);
    };
    EXPECT_NEAR(readings[0].value, expected(middle, true), 2e-3 * readings[0].value);
    EXPECT_NEAR(readings[1].value, expected(limb, true), 2e-2 * readings[1].value);
    EXPECT_NEAR(readings[2].value, expected(beside, false), 2e-3 * readings[2].value);
    EXPECT_GT(readings[0].value, 1e9) << "cd/m²";
    EXPECT_LT(readings[1].value, 0.7 * readings[0].value) << "darker at the limb";
}

TEST(DaylightModels, OfASettingSunWhatIsAboveTheHorizonShinesAndIsSeen) {
    for (const float elevation : {0.15f, 0.0f, -0.1f}) {
        Scene scene;
        Sky sky = daylight(SkyModel::hosek, elevation, true);
        scene.set_sky(sky);
        const auto towards = [&](float elevation_deg) {
            return shading::direction_from_azimuth(sky.sun_azimuth_rad, glm::radians(elevation_deg), sky.north_rad);
        };
        add_lux(scene, {0, 0, 0}, towards(0));
        add_sensor(scene, SensorType::luminance, {0, 0, 0}, towards(0.05f));
        add_sensor(scene, SensorType::luminance, {0, 0, 0}, towards(-0.05f));
        const auto with = measure(scene, 1 << 13, 1);
        const double ground = luminance(glm::dvec3(convert::pack_sky(scene).ground));
        sky.sun_disc = false;
        scene.set_sky(sky);
        const double normal = luminance(sunlight(sky).normal());
        const SensorReading without = measure(scene, 1 << 13, 1)[0];
        EXPECT_NEAR(with[0].value - without.value, normal, 0.01 * normal + with[0].half_width_95 + without.half_width_95) << elevation;
        const double radius = 0.5 * sky.sun_angular_diameter_rad;
        EXPECT_GT(with[1].value, 0.9 * normal / (std::numbers::pi * radius * radius)) << elevation;
        EXPECT_NEAR(with[2].value, ground, 1e-3 * ground) << elevation << ": not over the ground";
    }
}

TEST(DaylightModels, AWallBetweenTheSunAndAPointLeavesTheSky) {
    Scene scene;
    scene.set_sky(daylight(SkyModel::preetham, 45, true));
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    const glm::vec3 to_sun = shading::direction_from_azimuth(0.9f, glm::radians(45.0f), 0.3f);
    add_shape(scene, Disk{40.0f * to_sun, -to_sun, 1}, lambert(0, 0, true));
    const double sky = shading::horizontal_illuminance(convert::pack_sky(scene));
    const SensorReading reading = measure(scene, 1 << 14, 1)[0];
    EXPECT_NEAR(reading.value, sky, 0.005 * sky + reading.half_width_95) << "less a 1600th of the sky";
}

TEST(DaylightModels, TheSunFollowsItsSkyFromMorningToNight) {
    Scene scene;
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    PathTracer tracer;
    PathOptions options;
    options.samples_per_pixel = 1 << 10;
    double before = 0;
    for (const float elevation : {-30.0f, -3.0f, 1.0f, 20.0f, 55.0f}) {
        scene.set_sky(daylight(SkyModel::hosek, elevation, true));
        ASSERT_TRUE(tracer.update(scene));
        const auto readings = tracer.measure(scene, options);
        ASSERT_TRUE(readings);
        EXPECT_GT((*readings)[0].value, 2 * before) << elevation;
        before = (*readings)[0].value;
    }
    scene.set_sky(Sky{});
    ASSERT_TRUE(tracer.update(scene));
    EXPECT_EQ((*tracer.measure(scene, options))[0].value, 0) << "no sky, no sun";
}

}  // namespace
}  // namespace heliodon::tests
