// What surfaces reflect specularly of lights lights others: against the path tracer.
#include "gi_test.h"

namespace heliodon::tests {
namespace {

/// Indirect light of what the camera sees, one bounce of it.
struct Seen {
    double path = 0, ahead = 0, to_all_sides = 0;
};

class GiCaustics : public GlobalIllumination {
protected:
    Seen seen(Scene& scene, const Camera& camera) {
        constexpr int size = 32;
        Seen result;
        result.path = mean_luminance(layer(path_traced(scene, camera, size, 1024, 2, {"indirect"}), "indirect"));
        for (const bool caustics : {false, true}) {
            use_cone_tracing(scene, 64);
            RenderSettings settings = scene.render_settings();
            settings.bounces = 1;
            settings.vct.narrow = true;
            settings.vct.caustics = caustics;
            scene.set_render_settings(settings);
            start_over();
            (caustics ? result.ahead : result.to_all_sides) = mean_luminance(layer(cone_traced(scene, camera, size, 16), "indirect"));
        }
        RecordProperty("ahead", std::to_string(result.ahead / result.path));
        RecordProperty("to_all_sides", std::to_string(result.to_all_sides / result.path));
        return result;
    }
    static Material rough(glm::vec3 color, float metallic, float roughness) {
        Material material;
        material.base_color = color;
        material.metallic = metallic;
        material.roughness = roughness;
        return material;
    }
};

glm::vec3 turned(glm::vec3 v, float yaw_rad) {
    return {std::cos(yaw_rad) * v.x + std::sin(yaw_rad) * v.z, v.y, std::cos(yaw_rad) * v.z - std::sin(yaw_rad) * v.x};
}

/// A wall behind a floor, under a sun and a black sky; all of it turned about the vertical.
struct Corner {
    Scene scene;
    NodeId sun;

    Corner(const Material& wall, const Material& floor, glm::vec3 sun_direction, float yaw_rad = 0) {
        const auto at = [&](float x, float y, float z) { return turned({x, y, z}, yaw_rad); };
        add_shape_node(scene, Quad{at(-1.5f, 0, -1), at(0, 0, 2.4f), at(3, 0, 0)}, scene.add_material(floor));
        add_shape_node(scene, Quad{at(-1.5f, 0, -1), at(3, 0, 0), at(0, 2, 0)}, scene.add_material(wall));
        sun = add_sun(scene, turned(sun_direction, yaw_rad), glm::vec3(10000));
    }
};

TEST_F(GiCaustics, AWallThatTheSunGrazesLightsTheFloorBelowIt) {
    Corner corner(rough(glm::vec3(0.3f), 0, 0.6f), lambert(glm::vec3(0.5f)), {0, -0.966f, -0.259f});
    const Seen floor = seen(corner.scene, camera_above(1.7f, 0.9f));
    EXPECT_NEAR(floor.ahead / floor.path, 1, 0.04);  // 1.014
    // 0.613: evenly to all sides, at the mean albedo
    EXPECT_LT(floor.to_all_sides / floor.path, 0.7);
}

TEST_F(GiCaustics, ItDoesSoHoweverItLiesInTheLattice) {
    for (const float yaw_rad : {0.5236f, 0.7854f}) {
        Corner corner(rough(glm::vec3(0.3f), 0, 0.6f), lambert(glm::vec3(0.5f)), {0, -0.966f, -0.259f}, yaw_rad);
        Camera camera = camera_above(1.7f, 0.9f);
        camera.up = turned(camera.up, yaw_rad);
        const Seen floor = seen(corner.scene, camera);
        EXPECT_NEAR(floor.ahead / floor.path, 1, 0.04) << yaw_rad;  // 0.982 at 45°
        EXPECT_LT(floor.to_all_sides / floor.path, 0.7);
    }
}

TEST_F(GiCaustics, WhatAMetalAloneReflectsOfALampGoesOnBouncing) {
    // Nothing but the metal is lit, and nothing shines back evenly after one bounce.
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));
    add_shape_node(scene, Quad{{-0.15f, 0, -0.15f}, {0, 0, 0.3f}, {0.3f, 0, 0}}, scene.add_material(rough(glm::vec3(0.9f), 1, 0.4f)));
    add_shape_node(scene, Quad{{-1, 0, -1}, {2, 0, 0}, {0, 1.5f, 0}}, white);
    add_shape_node(scene, Quad{{1, 0, -1}, {0, 0, 2}, {0, 1.5f, 0}}, white);
    Node lamp;
    lamp.transform.translation = {0, 1.2f, 1.2f};
    lamp.transform.rotation = rotation_from_euler_deg({-45, 0, 0});
    lamp.light = Light{.type = LightType::spot, .intensity = glm::vec3(10000), .inner_rad = 0.06f, .outer_rad = 0.08f};
    scene.add_node(lamp);
    const Camera side_wall = inside({-0.6f, 0.6f, 0.3f}, {1, 0.6f, 0}, 0.9f);
    use_cone_tracing(scene, 64);
    const auto indirect = [&](int bounces) {
        RenderSettings settings = scene.render_settings();
        settings.bounces = bounces;
        scene.set_render_settings(settings);
        start_over();
        return mean_luminance(layer(cone_traced(scene, side_wall, 32, 4), "indirect"));
    };
    const double path = mean_luminance(layer(path_traced(scene, side_wall, 32, 4096, 3, {"indirect"}), "indirect"));
    const double one = indirect(1), two = indirect(2);
    RecordProperty("two", std::to_string(two / path));
    EXPECT_LT(one, 0.8 * path);
    EXPECT_NEAR(two / path, 1, 0.08);  // 0.937
}

TEST_F(GiCaustics, ASunlitMetalFloorLightsTheWallAhead) {
    Corner corner(lambert(glm::vec3(0.5f)), rough(glm::vec3(0.9f, 0.7f, 0.4f), 1, 0.4f), {0, -0.6f, -0.8f});
    const Seen wall = seen(corner.scene, inside({0, 0.8f, 0.6f}, {0, 0.8f, -1}, 0.9f));
    EXPECT_NEAR(wall.ahead / wall.path, 1, 0.04);  // 0.984
    EXPECT_LT(wall.to_all_sides / wall.path, 0.4);  // 0.281
}

TEST_F(GiCaustics, WhatReflectsNothingSpecularlyIsTheSameWithoutThem) {
    Corner corner(lambert(glm::vec3(0.7f, 0.5f, 0.3f)), lambert(glm::vec3(0.5f)), {0, -0.6f, -0.8f});
    use_cone_tracing(corner.scene, 32);
    const Camera camera = inside({0, 0.8f, 1.2f}, {0, 0.3f, -1}, 0.9f);
    const Image with = cone_traced(corner.scene, camera, 32, 2).image;
    RenderSettings settings = corner.scene.render_settings();
    settings.vct.caustics = false;
    corner.scene.set_render_settings(settings);
    start_over();
    EXPECT_EQ(cone_traced(corner.scene, camera, 32, 2).image.pixels, with.pixels);
}

TEST_F(GiCaustics, ALightThatGoesOutTakesItsLobesWithIt) {
    Corner corner(rough(glm::vec3(0.9f), 1, 0.3f), lambert(glm::vec3(0.5f)), {0, -0.6f, -0.8f});
    use_cone_tracing(corner.scene, 32);
    const Camera camera = inside({0, 0.8f, 1.2f}, {0, 0.3f, -1}, 0.9f);
    EXPECT_GT(mean_luminance(layer(cone_traced(corner.scene, camera, 16, 1), "indirect")), 1);
    corner.scene.set_visible(corner.sun, false);
    EXPECT_EQ(mean_luminance(layer(cone_traced(corner.scene, camera, 16, 1), "indirect")), 0);
}

}  // namespace
}  // namespace heliodon::tests
