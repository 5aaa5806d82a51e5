#include "engine_parity.h"
#include "import/import.h"
#include "shared_data.h"

namespace heliodon::tests {
namespace {

using Parity = EngineParity;

TEST_F(Parity, APointLightInTheCornellBoxIsWhatThePathTracerSays) {
    const auto path = shared_path("scenes/cornell-point.heliodon.json");
    if (!path) GTEST_SKIP() << "no shared data";
    Warnings warnings;
    const auto scene = load_scene(*path, {}, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    expect_agreement(*scene, {}, {0.0005, 0.0005, 0.005});
}

TEST_F(Parity, APointASpotAndADirectionalLightTogetherAreWhatThePathTracerSays) {
    const auto path = shared_path("scenes/cornell-point.heliodon.json");
    if (!path) GTEST_SKIP() << "no shared data";
    Warnings warnings;
    auto scene = load_scene(*path, {}, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    Node spot;
    spot.transform.translation = {-0.7f, 1.9f, 0.8f};
    spot.transform.rotation = rotation_from_euler_deg({-60, -30, 0});
    spot.light = Light{.type = LightType::spot, .intensity = {80, 60, 40}, .inner_rad = 0.26f, .outer_rad = 0.44f};
    scene->add_node(spot);
    add_sun(*scene, {0.3f, -0.6f, -1}, {40, 50, 60});
    // One light is chosen a sample, which leaves the reference a noise of about a hundredth at this count.
    expect_agreement(*scene, {.path_samples = 256}, {0.02, 0.001, 0.02});
}

TEST_F(Parity, GlossyMetalAndDielectricSpheresAreWhatThePathTracerSays) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));
    add_floor(scene, 2, white);
    for (int i = 0; i < 4; ++i) {
        Material glossy;
        glossy.base_color = {0.9f, 0.6f, 0.3f};
        glossy.metallic = i < 2 ? 1.0f : 0.0f;
        glossy.roughness = i % 2 ? 0.5f : 0.25f;
        add_shape_node(scene, Sphere{{-1.2f + 0.8f * i, 0.35f, 0}, 0.35f}, scene.add_material(glossy));
    }
    add_point_light(scene, {0.5f, 2, 1.5f}, glm::vec3(60));
    Camera camera;
    camera.position = {0, 1.2f, 3};
    camera.target = {0, 0.3f, 0};
    camera.ev100_override = 2.0f;
    scene.add_camera(camera);
    // The spheres are tessellated here and exact there.
    expect_agreement(scene, {}, {0.002, 0.005, 0.01});
}

}  // namespace
}  // namespace heliodon::tests
