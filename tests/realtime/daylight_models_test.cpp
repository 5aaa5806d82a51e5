// Daylight in the real-time engine against the path tracer, under every formula at eight heights of the sun.
#include <algorithm>

#include "convert/pack.h"
#include "engine_parity.h"
#include "shading/cie_sky.h"
#include "shading/daylight.h"
#include "shading/sky.h"

namespace heliodon::tests {
namespace {

class DaylightModels : public EngineParity {};

Sky sky_at(SkyModel model, float elevation_deg, bool disc) {
    Sky sky;
    sky.model = model;
    sky.cie_type = 12;
    sky.sun_azimuth_rad = 0.7f;
    sky.sun_elevation_rad = glm::radians(elevation_deg);
    sky.north_rad = 0.2f;
    sky.sun_disc = disc;
    return sky;
}

TEST_F(DaylightModels, APlaneAndTheSidesOfASphereReceiveWhatThePathTracerSays) {
    Scene scene;
    for (const glm::vec3 normal : {glm::vec3(0, 1, 0), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(-.6f, .5f, .6f), glm::vec3(.3f, -.8f, .4f)})
        scene.add_sensor({"s" + std::to_string(scene.sensors().size()), SensorType::illuminance, {0, 0, 0}, glm::normalize(normal), {}, {}});
    PathTracer tracer;
    PathOptions path;
    path.samples_per_pixel = 1 << 12;
    path.max_depth = 1;
    for (const SkyModel model : {SkyModel::hosek, SkyModel::preetham, SkyModel::cie})
        for (const float elevation : {-4.0f, 0.0f, 3.0f, 10.0f, 25.0f, 45.0f, 65.0f, 88.0f}) {
            scene.set_sky(sky_at(model, std::max(elevation, model == SkyModel::cie ? 0.0f : -90.0f), false));
            ASSERT_TRUE(tracer.update(scene));
            const auto here = renderer->measure(scene, {}), truth = tracer.measure(scene, path);
            ASSERT_TRUE(here && truth);
            for (std::size_t i = 0; i < here->size(); ++i) {
                const double a = (*here)[i].value, b = (*truth)[i].value;
                EXPECT_NEAR(a, b, 0.02 * b) << static_cast<int>(model) << " at " << elevation << "°, side " << i;
            }
        }
}

TEST_F(DaylightModels, TheSunShinesOnAPlaneAsInThePathTracerAndGoesOutWithItsSky) {
    Scene scene;
    scene.add_sensor({"s", SensorType::illuminance, {0, 0, 0}, {0, 1, 0}, {}, {}});
    for (const float elevation : {0.1f, 30.0f}) {
        scene.set_sky(sky_at(SkyModel::hosek, elevation, true));
        const auto here = renderer->measure(scene, {});
        ASSERT_TRUE(here);
        const double direct = units::luminance(
            shading::sunlight(shading::sky_model_hosek, scene.sky().turbidity, glm::radians(double(elevation)), scene.sky().sun_angular_diameter_rad)
                .level());
        const double expected = shading::horizontal_illuminance(convert::pack_sky(scene)) + direct;
        EXPECT_NEAR((*here)[0].value, expected, 0.01 * expected) << elevation;
    }
    scene.set_sky(Sky{});
    EXPECT_EQ((*renderer->measure(scene, {}))[0].value, 0);
}

TEST_F(DaylightModels, ASettingSunShinesOnAWallAsInThePathTracer) {
    Scene scene;
    const Sky facing = sky_at(SkyModel::hosek, 0, true);
    const glm::vec3 towards = shading::direction_from_azimuth(facing.sun_azimuth_rad, 0, facing.north_rad);
    scene.add_sensor({"s", SensorType::illuminance, {0, 0, 0}, towards, {}, {}});
    PathTracer tracer;
    PathOptions path;
    path.samples_per_pixel = 1 << 13;
    path.max_depth = 1;
    for (const float elevation : {0.15f, -0.1f}) {
        scene.set_sky(sky_at(SkyModel::hosek, elevation, true));
        ASSERT_TRUE(tracer.update(scene));
        const auto here = renderer->measure(scene, {}), truth = tracer.measure(scene, path);
        ASSERT_TRUE(here && truth);
        EXPECT_NEAR((*here)[0].value, (*truth)[0].value, 0.01 * (*truth)[0].value) << elevation;
    }
}

}  // namespace
}  // namespace heliodon::tests
