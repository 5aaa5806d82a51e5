#include <cmath>

#include "engine_parity.h"

namespace heliodon::tests {
namespace {

constexpr float pi = 3.14159265f;

class LightParity : public EngineParity {
protected:
    Scene scene;
    MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));

    void look(glm::vec3 from, glm::vec3 at, float ev100) {
        Camera camera;
        camera.position = from;
        camera.target = at;
        camera.vertical_fov_rad = 0.8f;
        camera.ev100_override = ev100;
        scene.add_camera(camera);
    }
    NodeId add_sphere_light(glm::vec3 position, glm::vec3 intensity_cd, float radius_m) {
        Node node;
        node.transform.translation = position;
        node.light = Light{.type = LightType::point, .intensity = intensity_cd, .radius_m = radius_m};
        return scene.add_node(std::move(node));
    }
    void use_small_shadow_maps() {
        RenderSettings settings = scene.render_settings();
        settings.shadow_map_size = 512;
        scene.set_render_settings(settings);
    }
};

TEST_F(LightParity, SphereLightsAreSeenAloneAndPartlyBehindABox) {
    use_small_shadow_maps();
    add_floor(scene, 2, white);
    add_shape_node(scene, Box{{0.2f, 0, -0.2f}, {0.7f, 0.7f, 0.3f}}, white);
    add_sphere_light({-0.5f, 0.9f, 0}, {4, 2, 1}, 0.2f);
    add_sphere_light({0.75f, 0.7f, -0.6f}, {1, 2, 4}, 0.25f);
    look({0, 1.2f, 3}, {0, 0.6f, 0}, 2.0f);
    // With fewer points of each light the real-time picture is still a few per cent off between them.
    const Pictures pictures = expect_agreement(scene, {96, 256, 256}, {0.02, 0.001, 0.015});
    // The disc's radiance is I/(πr²) in both.
    const glm::vec4 seen = [&] {
        const glm::vec3 offset = glm::vec3(-0.5f, 0.9f, 0) - glm::vec3(0, 1.2f, 3);
        const glm::vec3 forward = glm::normalize(glm::vec3(0, -0.6f, -3));
        const glm::vec3 right(1, 0, 0), up = glm::cross(right, forward);
        const float depth = glm::dot(offset, forward) * std::tan(0.4f);
        return glm::vec4(48 * (1 + glm::dot(offset, right) / depth), 48 * (1 - glm::dot(offset, up) / depth), 0, 0);
    }();
    const int x = static_cast<int>(seen.x), y = static_cast<int>(seen.y);
    EXPECT_NEAR(pictures.realtime.image.at(x, y, 0), 4 / (pi * 0.04f), 1e-3f);
    EXPECT_NEAR(pictures.path.image.at(x, y, 0), 4 / (pi * 0.04f), 1e-3f);
}

TEST_F(LightParity, ADirectionalLightsDiscIsSeenInTheSkyAndBehindABox) {
    use_small_shadow_maps();
    add_floor(scene, 2, white);
    add_shape_node(scene, Box{{-0.1f, 0, -0.3f}, {0.4f, 1.1f, 0.2f}}, white);
    Node sun;
    sun.light = Light{.type = LightType::directional, .intensity = {2, 3, 4}, .angular_diameter_rad = 0.3f,
                      .direction = glm::normalize(glm::vec3(0.02f, -0.1f, 1))};
    scene.add_node(sun);
    look({0, 0.9f, 3}, {0, 0.9f, 0}, 2.0f);
    expect_agreement(scene, {96, 64, 128}, {0.03, 0.005, 0.02});
}

TEST_F(LightParity, LightsBeforeAndBehindABlendedSheetShineThroughTheirShareOfIt) {
    use_small_shadow_maps();
    Material tinted = lambert({0.2f, 0.6f, 0.3f});
    tinted.alpha_mode = AlphaMode::blend;
    tinted.opacity = 0.6f;
    tinted.two_sided = true;
    add_floor(scene, 2, white);
    add_shape_node(scene, Quad{{-0.7f, 0, 0}, {1.4f, 0, 0}, {0, 1.4f, 0}}, scene.add_material(tinted));
    add_sphere_light({-0.3f, 0.7f, 0.5f}, {0.4f, 0.3f, 0.2f}, 0.2f);
    add_sphere_light({0.3f, 0.7f, -0.5f}, {0.4f, 0.4f, 0.4f}, 0.2f);
    look({0, 0.8f, 3}, {0, 0.6f, 0}, 0.0f);
    expect_agreement(scene, {96, 256, 256}, {0.08, 0.005, 0.02});
}

TEST_F(LightParity, ThePenumbraOfASphereLightBehindAnEdgeHasThePathTracersProfile) {
    use_small_shadow_maps();
    add_floor(scene, 4, white);
    add_shape_node(scene, Quad{{-4, 0.5f, -4}, {0, 0, 8}, {4, 0, 0}}, white);  // covers x < 0
    add_sphere_light({0, 2, 0}, glm::vec3(10), 0.3f);
    Camera camera;  // under the sheet's height, straight down
    camera.position = {0.15f, 0.45f, 0};
    camera.target = {0.15f, 0, 0};
    camera.up = {0, 0, -1};
    camera.vertical_fov_rad = 2 * std::atan(0.4f / 0.45f);
    camera.ev100_override = 1.0f;
    scene.add_camera(camera);
    const Pictures pictures = expect_agreement(scene, {96, 192, 128}, {0.05, 0.005, 0.02});
    const auto column = [](const Image& image, int x) {
        float sum = 0;
        for (int y = 0; y < image.height; ++y) sum += image.at(x, y);
        return sum / static_cast<float>(image.height);
    };
    const float lit = column(pictures.path.image, 95);
    EXPECT_EQ(column(pictures.realtime.image, 0), 0.0f);
    EXPECT_EQ(column(pictures.path.image, 0), 0.0f);
    // A column sees the edge cut one and the same set of 192 points of the light, half of them on its far side: a
    // step of a hundredth each. In the mean over columns that evens out.
    float difference = 0;
    int partly_lit = 0;
    for (int x = 0; x < 96; ++x) {
        const float seen = column(pictures.realtime.image, x), expected = column(pictures.path.image, x);
        EXPECT_NEAR(seen, expected, 0.05f * lit) << x;
        difference += (seen - expected) / 96;
        partly_lit += expected > 0.05f * lit && expected < 0.85f * lit;
    }
    EXPECT_NEAR(difference, 0, 0.005f * lit);
    EXPECT_GE(partly_lit, 10);
}

}  // namespace
}  // namespace heliodon::tests
