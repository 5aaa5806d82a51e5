// Luminaires in the path tracer: measured intensities by the inverse-square law, the whole flux, what rays see.
#include <numbers>

#include "import/import.h"
#include "scene_building.h"
#include "shared_data.h"

namespace heliodon::tests {
namespace {

constexpr double degree = std::numbers::pi / 180;

std::shared_ptr<const Luminaire> shared_luminaire(const char* file) {
    const auto path = shared_path(std::string("photometry/") + file);
    if (!path) return nullptr;
    Warnings warnings;
    auto luminaire = load_luminaire(*path, 1, warnings);
    EXPECT_TRUE(luminaire) << luminaire.error().text();
    return luminaire ? *luminaire : nullptr;
}

Light light_of(std::shared_ptr<const Luminaire> luminaire) {
    Light light{.type = LightType::luminaire, .intensity = glm::vec3(static_cast<float>(luminaire->peak_cd))};
    light.luminaire = std::move(luminaire);
    return light;
}

/// 0 downwards, C0 to +x, C90 to −z.
glm::vec3 direction(double c_rad, double gamma_rad) {
    return glm::vec3(std::sin(gamma_rad) * std::cos(c_rad), -std::cos(gamma_rad),
                     -std::sin(gamma_rad) * std::sin(c_rad));
}

class LuminaireFile : public testing::TestWithParam<const char*> {};

TEST_P(LuminaireFile, WithoutAnOpeningLightsByTheMeasuredIntensitiesOverTheSquareOfTheDistance) {
    const auto measured = shared_luminaire(GetParam());
    if (!measured) GTEST_SKIP() << "needs the shared photometric files";
    Luminaire small = *measured;
    small.opening = {};
    const PhotometricWeb& web = small.web;
    const glm::quat turned = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
    Scene scene;
    std::vector<double> expected;
    constexpr float distance = 2.5f;
    for (std::size_t i = 0; i < 40; ++i) {
        const std::size_t azimuth = i * 7 % web.azimuth_rad.size(), polar = i * 11 % web.polar_rad.size();
        const glm::vec3 away = turned * direction(web.azimuth_rad[azimuth], web.polar_rad[polar]);
        // At the last polar angle light ends; nothing is asked there.
        if (polar + 1 == web.polar_rad.size()) continue;
        add_lux(scene, glm::vec3(1, 2, 3) + distance * away, -away);
        expected.push_back(web.at(azimuth, polar) / (distance * distance));
    }
    add_light(scene, light_of(std::make_shared<const Luminaire>(small)), {1, 2, 3}, turned);
    const auto readings = measure(scene, 4, 1);
    ASSERT_EQ(readings.size(), expected.size());
    for (std::size_t i = 0; i < readings.size(); ++i)
        EXPECT_NEAR(readings[i].value, expected[i], 2e-4 * small.peak_cd / (distance * distance)) << i;
}

TEST_P(LuminaireFile, SendsItsWholeFluxThroughTheWallsOfABlackRoom) {
    const auto luminaire = shared_luminaire(GetParam());
    if (!luminaire) GTEST_SKIP() << "needs the shared photometric files";
    Scene scene;
    add_light(scene, light_of(luminaire), {0.1f, 0.25f, -0.1f});
    constexpr int cells = 24;
    constexpr float half = 1.5f,
                    step = 2 * half / cells;  // the lamp's horizon, where light may end, lies between cells
    for (int wall = 0; wall < 6; ++wall)
        for (int i = 0; i < cells; ++i)
            for (int k = 0; k < cells; ++k) {
                glm::vec3 position(0), normal(0);
                const int axis = wall / 2;
                const float side = wall % 2 ? 1.0f : -1.0f;
                position[axis] = side * half;
                position[(axis + 1) % 3] = -half + (static_cast<float>(i) + 0.5f) * step;
                position[(axis + 2) % 3] = -half + (static_cast<float>(k) + 0.5f) * step;
                normal[axis] = -side;
                add_lux(scene, position, normal);
            }
    double flux = 0;
    for (const SensorReading& reading : measure(scene, 64, 1)) flux += reading.value * step * step;
    std::printf("             %.5f of the measured flux\n", flux / luminaire->flux_lm);
    EXPECT_NEAR(flux / luminaire->flux_lm, 1, 0.002);
}

INSTANTIATE_TEST_SUITE_P(Shared, LuminaireFile,
                         testing::Values("maxwell-8-led.ies", "indoor-60w.ies", "ABSOLUTE_LED.ies", "floor_uplight.ldt",
                                         "fluorescent_luminaire.ldt", "road_luminaire.ldt", "projector.ldt",
                                         "demo_two_lamp_sets.ldt"),
                         [](const auto& info) {
                             std::string name = info.param;
                             for (char& c : name)
                                 if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                             return name;
                         });

/// 200 cd downwards falling to 0 at the horizon, of this opening.
Luminaire downlight(const LuminousOpening& opening) {
    Luminaire luminaire;
    for (int i = 0; i <= 18; ++i) {
        luminaire.web.polar_rad.push_back(i * 5 * degree);
        luminaire.web.candela.push_back(200 * std::cos(i * 5 * degree));
    }
    luminaire.web.azimuth_rad = {0};
    luminaire.opening = opening;
    integrate(luminaire);
    return luminaire;
}

// A disc whose intensity falls with the cosine has one luminance: that of a glowing disc of the same size.
TEST(Luminaire, ADiscOfEvenLuminanceIsAGlowingDisc) {
    constexpr float radius = 0.4f;
    const double nits = 200 / (pi * radius * radius);
    Scene scene, glowing;
    add_light(
        scene,
        light_of(std::make_shared<const Luminaire>(downlight({OpeningShape::cylinder_y, {2 * radius, 0, 2 * radius}}))),
        {0, 1, 0});
    add_shape(glowing, Disk{{0, 1, 0}, {0, -1, 0}, radius}, lambert(0, static_cast<float>(nits)));
    for (Scene* each : {&scene, &glowing}) {
        for (const glm::vec3 place : {glm::vec3(0, 0.8f, 0), glm::vec3(0.5f, 0.5f, 0), glm::vec3(1, 0.9f, 0.3f)})
            add_lux(*each, place, glm::vec3(0, 1, 0));
        add_sensor(*each, SensorType::luminance, {0.1f, 0, 0}, glm::vec3(0, 1, 0.1f));
        add_sensor(*each, SensorType::luminance, {0.1f, 2, 0}, glm::vec3(0, -1, 0.1f));
    }
    const auto readings = measure(scene, 1 << 14), expected = measure(glowing, 1 << 14);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(readings[i].value, expected[i].value, 0.003 * expected[i].value + 3 * readings[i].half_width_95)
            << i;
    EXPECT_NEAR(readings[3].value, nits, 2e-3 * nits);
    EXPECT_EQ(readings[4].value, 0);  // from above
}

TEST(Luminaire, ASphereOfEvenIntensityIsASphereLight) {
    Luminaire luminaire;
    luminaire.web = {.polar_rad = {0, std::numbers::pi}, .azimuth_rad = {0}, .candela = {50, 50}};
    luminaire.opening = {OpeningShape::ellipsoid, glm::vec3(0.6f)};
    integrate(luminaire);
    Scene scene, sphere;
    add_light(scene, light_of(std::make_shared<const Luminaire>(luminaire)), {0, 1, 0});
    add_light(sphere, point_light(50, 0.3f), {0, 1, 0});
    Material glossy;
    glossy.base_color = glm::vec3(0.9f);
    glossy.metallic = 1;
    glossy.roughness = 0.25f;
    for (Scene* each : {&scene, &sphere}) {
        add_shape(*each, Quad{{-3, 0, -3}, {0, 0, 6}, {6, 0, 0}}, glossy);
        add_lux(*each, {0.2f, 0.6f, 0.1f}, glm::vec3(0, 1, 0));
        add_sensor(*each, SensorType::luminance, {-1.2f, 0.9f, 0},
                   glm::vec3(1, -0.8f, 0));  // its reflection, by both strategies
        add_sensor(*each, SensorType::luminance, {-1.2f, 0.9f, 0}, glm::vec3(1, 0.1f, 0));
    }
    const auto readings = measure(scene, 1 << 14), expected = measure(sphere, 1 << 14);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_GT(expected[i].value, 0);
        EXPECT_NEAR(readings[i].value, expected[i].value,
                    0.002 * expected[i].value + 3 * (readings[i].half_width_95 + expected[i].half_width_95))
            << i;
    }
}

TEST(Luminaire, GivesWhatItsLampsGiveAtItsTilt) {
    Luminaire luminaire = downlight({});
    luminaire.tilt_rad = {0, 90 * degree};
    luminaire.tilt_factor = {1, 0.5};
    for (const double tilt_deg : {0.0, 30.0, 90.0, 150.0}) {
        Scene scene;
        const glm::quat turn = glm::angleAxis(static_cast<float>(tilt_deg * degree), glm::vec3(0, 0, 1));
        add_light(scene, light_of(std::make_shared<const Luminaire>(luminaire)), {0, 0, 0}, turn);
        const glm::vec3 away = turn * glm::vec3(0, -1, 0);
        add_lux(scene, away, -away);
        EXPECT_NEAR(measure(scene, 4, 1)[0].value, 200 * std::max(0.5, 1 - tilt_deg / 180), 1e-2) << tilt_deg;
    }
}

// Type B counts polar angles from a horizontal axis: its photometric zero still looks down, its plane of 0 to C0.
TEST(Luminaire, TypeBLooksDownAndTurnsAboutTheHorizontal) {
    Luminaire luminaire;
    luminaire.web = {.axis = PhotometricWeb::Axis::horizontal,
                     .polar_rad = {0, 90 * degree, 180 * degree},
                     .azimuth_rad = {0, 90 * degree, 180 * degree, 270 * degree, 360 * degree},
                     .candela = {1, 10, 5, 1, 2, 5, 1, 3, 5, 1, 4, 5, 1, 10, 5}};
    luminaire.opening = {OpeningShape::box, {0.01f, 0, 0.04f}};
    integrate(luminaire);
    Scene scene;
    add_light(scene, light_of(std::make_shared<const Luminaire>(luminaire)), {0, 0, 0});
    const std::pair<glm::vec3, double> expected[] = {{{0, -1, 0}, 10}, {{0, 0, -1}, 2}, {{0, 1, 0}, 3},
                                                     {{0, 0, 1}, 4},   {{-1, 0, 0}, 1}, {{1, 0, 0}, 5}};
    for (const auto& [away, candela] : expected) add_lux(scene, 4.0f * away, -away);
    const auto readings = measure(scene, 256, 1);
    for (std::size_t i = 0; i < readings.size(); ++i)
        // Edge on, the rectangle is not there. From below it is the mean over its own angles, about a peak.
        if (std::abs(expected[i].first.y) > 0) {
            EXPECT_NEAR(readings[i].value * 16, expected[i].second, 0.02) << i;
        }
    // The rectangle lies flat, along z.
    add_sensor(scene, SensorType::luminance, {0.004f, -1, 0.019f}, {0, 1, 0});
    add_sensor(scene, SensorType::luminance, {0.019f, -1, 0.004f}, {0, 1, 0});
    const auto seen = measure(scene, 4, 1);
    EXPECT_NEAR(seen[6].value, 10 / (0.01 * 0.04), 30);
    EXPECT_EQ(seen[7].value, 0);
}

}  // namespace
}  // namespace heliodon::tests
