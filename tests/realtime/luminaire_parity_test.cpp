#include <cmath>

#include "engine_parity.h"
#include "import/import.h"
#include "shared_data.h"

namespace heliodon::tests {
namespace {

struct Lit {
    const char* file;
    const char* name;
    float height_m, ev100;
};

/// A wall, a floor and a box that throws a shadow, under one luminaire.
class LuminaireParity : public EngineParity, public testing::WithParamInterface<Lit> {};

TEST_P(LuminaireParity, DirectLightAndTheOpeningsOwnAreThoseOfThePathTracer) {
    const auto path = shared_path(std::string("photometry/") + GetParam().file);
    if (!path) GTEST_SKIP() << "needs the shared photometric files";
    Warnings warnings;
    const auto luminaire = load_luminaire(*path, 1, warnings);
    ASSERT_TRUE(luminaire) << luminaire.error().text();
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));
    add_floor(scene, 2.5f, white);
    add_shape_node(scene, Quad{{-2.5f, 0, -0.6f}, {5, 0, 0}, {0, 3.2f, 0}}, white);
    add_shape_node(scene, Box{{0.4f, 0, 0.2f}, {0.9f, 0.5f, 0.7f}}, white);
    Node lamp;
    lamp.transform.translation = {0, GetParam().height_m, 0};
    lamp.light = Light{.type = LightType::luminaire, .intensity = glm::vec3(static_cast<float>((*luminaire)->peak_cd))};
    lamp.light->luminaire = *luminaire;
    scene.add_node(lamp);
    Camera camera;
    camera.position = {0, 1.5f, 3.6f};
    camera.target = {0, 1.35f, 0};
    camera.vertical_fov_rad = 0.9f;
    camera.ev100_override = GetParam().ev100;
    scene.add_camera(camera);
    RenderSettings settings = scene.render_settings();
    settings.shadow_map_size = 512;
    scene.set_render_settings(settings);
    expect_agreement(scene, {64, 192, 96}, {0.03, 0.005, 0.03});
}

class LuminaireUpdate : public RealtimeTest {};

TEST_F(LuminaireUpdate, ALuminaireThatComesLaterIsSeenAndOneThatGoesIsNot) {
    const auto isotropic = [](double candela) {
        auto luminaire = std::make_shared<Luminaire>();
        luminaire->web = {.polar_rad = {0, 3.14159265}, .azimuth_rad = {0}, .candela = {candela, candela}};
        integrate(*luminaire);
        Light light{.type = LightType::luminaire, .intensity = glm::vec3(static_cast<float>(candela))};
        light.luminaire = std::move(luminaire);
        return light;
    };
    Scene scene;
    add_floor(scene, 1, scene.add_material(lambert(glm::vec3(1))));
    Node node;
    node.transform.translation = {0, 1, 0};
    const NodeId first = scene.add_node(node), second = scene.add_node(node);
    Camera camera;
    camera.position = {0, 0.9f, 0};
    camera.target = {0, 0, 0};
    camera.up = {0, 0, -1};
    camera.vertical_fov_rad = 0.02f;
    const auto luminance = [&] { return render(scene, camera, 8).at(4, 4, 0) * 3.14159265f; };
    EXPECT_EQ(luminance(), 0.0f);
    scene.set_light(first, isotropic(5));
    EXPECT_NEAR(luminance(), 5, 1e-3);
    scene.set_light(second, isotropic(2));
    EXPECT_NEAR(luminance(), 7, 1e-3);
    scene.set_light(first, std::nullopt);
    EXPECT_NEAR(luminance(), 2, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Shared, LuminaireParity,
                         testing::Values(Lit{"maxwell-8-led.ies", "Point", 2.4f, 6},
                                         Lit{"fluorescent_luminaire.ldt", "Rectangle", 2.4f, 8},
                                         Lit{"road_luminaire.ldt", "Cylinder", 2.4f, 11},
                                         Lit{"ABSOLUTE_LED.ies", "Box", 2.4f, 9},
                                         Lit{"floor_uplight.ldt", "DiscUpwards", 1.2f, 9.5f}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace heliodon::tests
