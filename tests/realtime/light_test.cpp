#include <algorithm>
#include <cmath>

#include "test_scenes.h"

namespace heliodon::tests {
namespace {

constexpr float pi = 3.14159265f;

using DirectLight = RealtimeTest;

TEST_F(DirectLight, APointLightOnALambertPlaneFollowsTheInverseSquareAndCosineLawEverywhere) {
    Scene scene;
    add_floor(scene, 4, scene.add_material(lambert({0.5f, 0.4f, 0.3f})));
    add_point_light(scene, {0.5f, 1.5f, -0.3f}, {100, 200, 300});
    const Image image = render(scene, camera_above(6, 3), 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const glm::vec3 to_light = glm::vec3(0.5f, 1.5f, -0.3f) - floor_point(x, y, 64, 3);
            const float d = glm::length(to_light);
            const float lux_per_candela = to_light.y / d / (d * d);
            const glm::vec3 expected = glm::vec3(100, 200, 300) * glm::vec3(0.5f, 0.4f, 0.3f) * lux_per_candela / pi;
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(image.at(x, y, c), expected[c], 1e-4f * expected[c]) << x << " " << y;
        }
}

TEST_F(DirectLight, AdirectionalLightGivesItsIlluminanceTimesTheCosine) {
    Scene scene;
    add_floor(scene, 4, scene.add_material(lambert(glm::vec3(1))));
    add_sun(scene, {1, -2, 0.5f}, {1000, 500, 250});
    const Image image = render(scene, camera_above(6, 3), 32);
    const float cosine = 2 / std::sqrt(1 + 4 + 0.25f);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) ASSERT_NEAR(image.at(x, y, 0), 1000 * cosine / pi, 1e-3f * 1000);
}

TEST_F(DirectLight, ASpotFallsOffBetweenItsConesAndIsDarkOutside) {
    Scene scene;
    add_floor(scene, 4, scene.add_material(lambert(glm::vec3(1))));
    const float inner = 0.4f, outer = 0.7f;
    Node spot;
    spot.transform.translation = {0, 2, 0};
    spot.transform.rotation = glm::angleAxis(-pi / 2, glm::vec3(1, 0, 0));  // −Z turns to −Y
    spot.light = Light{.type = LightType::spot, .intensity = glm::vec3(1000), .inner_rad = inner, .outer_rad = outer};
    scene.add_node(spot);
    const Image image = render(scene, camera_above(6, 3), 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const glm::vec3 to_light = glm::vec3(0, 2, 0) - floor_point(x, y, 64, 3);
            const float d = glm::length(to_light), cosine = to_light.y / d;
            const float t = std::clamp((cosine - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0f, 1.0f);
            const float expected = 1000 * t * t * cosine / (d * d) / pi;
            ASSERT_NEAR(image.at(x, y), expected, 2e-4f * expected + 1e-3f) << x << " " << y;
        }
}

TEST_F(DirectLight, ASceneWithoutLightsOrWithoutAnythingIsBlack) {
    Scene empty;
    const Image nothing = render(empty, camera_above(6, 3), 8, 2);
    for (const float value : nothing.pixels) ASSERT_EQ(value, 0.0f);
}

TEST_F(DirectLight, APictureCanBeOnePixel) {
    Scene scene;
    add_floor(scene, 4, scene.add_material(lambert(glm::vec3(1))));
    add_sun(scene, {0, -1, 0}, glm::vec3(pi));
    EXPECT_NEAR(render(scene, camera_above(6, 3), 1, 4).at(0, 0), 1.0f, 1e-4f);
}

TEST_F(DirectLight, AnEdgeThroughPixelsCornersCoversHalfOfThem) {
    Scene scene;
    const float r = std::sqrt(0.5f);  // the sheet ends along x + z = 0, the diagonal of the picture
    add_shape_node(scene, Quad{{0, 0, 0}, {20 * r, 0, 20 * r}, {20 * r, 0, -20 * r}}, scene.add_material(lambert(glm::vec3(1))),
                   Transform{.translation = {-10 * r, 0, 10 * r}});
    add_sun(scene, {0, -1, 0}, glm::vec3(pi));
    const Image image = render(scene, camera_above(6, 3), 16, 64);
    for (int i = 0; i < 16; ++i) EXPECT_NEAR(image.at(i, 15 - i), 0.5f, 1e-4f) << i;
    EXPECT_NEAR(image.at(15, 15), 1.0f, 1e-4f);
    EXPECT_EQ(image.at(0, 0), 0.0f);
}

TEST_F(DirectLight, APictureOfNoSizeIsRefused) {
    Scene scene;
    RealtimeOptions options;
    options.width = 0;
    const auto picture = renderer->render(scene, Camera{}, options);
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().text().find("0x"), std::string::npos);
}

TEST_F(DirectLight, OneSidedBacksAreBlackAndTwoSidedOnesAreLit) {
    Scene scene;
    Material two_sided = lambert(glm::vec3(1));
    two_sided.two_sided = true;
    // Facing down: their backs are seen and lit from above.
    add_shape_node(scene, Quad{{-2, 0, -1}, {1.5f, 0, 0}, {0, 0, 2}}, scene.add_material(lambert(glm::vec3(1))));
    add_shape_node(scene, Quad{{0.5f, 0, -1}, {1.5f, 0, 0}, {0, 0, 2}}, scene.add_material(two_sided));
    add_sun(scene, {0, -1, 0}, glm::vec3(pi));
    const Image image = render(scene, camera_above(6, 3), 32);
    EXPECT_EQ(image.at(8, 16), 0.0f);
    EXPECT_NEAR(image.at(23, 16), 1.0f, 1e-4f);
}

TEST_F(DirectLight, MoreLightsThanLargeShadowMapsFitShareThem) {
    Scene scene;
    RenderSettings settings;
    settings.shadow_map_size = 4096;  // room for six: one cube
    scene.set_render_settings(settings);
    add_floor(scene, 4, scene.add_material(lambert(glm::vec3(1))));
    for (const float x : {-1.0f, 0.0f, 1.0f}) add_point_light(scene, {x, 2, 0}, glm::vec3(100));
    RealtimeOptions options;
    options.width = options.height = 16;
    options.samples = 1;
    RealtimeStatistics statistics;
    const Picture picture = render(scene, camera_above(6, 3), options, &statistics);
    EXPECT_EQ(statistics.light_batches, 1);
    for (int i = 0; i < 16; ++i) {
        float expected = 0;
        for (const float x : {-1.0f, 0.0f, 1.0f}) {
            const glm::vec3 to_light = glm::vec3(x, 2, 0) - floor_point(i, 4, 16, 3);
            expected += 100 * to_light.y / std::pow(glm::length(to_light), 3.0f) / pi;
        }
        EXPECT_NEAR(picture.image.at(i, 4), expected, 1e-4f * expected);
    }
}

}  // namespace
}  // namespace heliodon::tests
