// What cones bring to surfaces that one looks through: alpha-blended sheets and solids of glass, against the path tracer.
#include "gi_test.h"

namespace heliodon::tests {
namespace {

constexpr int picture_size = 48;

class GiGlass : public GlobalIllumination {
protected:
    /// Mean luminance of the pixels x0 ≤ x < x1 of the middle rows.
    static double middle(const Image& image, double x0, double x1) {
        double sum = 0;
        int count = 0;
        for (int y = image.height * 2 / 5; y < image.height * 3 / 5; ++y)
            for (int x = static_cast<int>(x0 * image.width); x < static_cast<int>(x1 * image.width); ++x, ++count)
                sum += units::luminance(image.rgb(x, y));
        return sum / count;
    }
};

Camera facing(glm::vec3 eye, glm::vec3 target, float half) {
    Camera camera;
    camera.position = eye;
    camera.target = target;
    camera.vertical_fov_rad = 2 * std::atan(half / glm::length(target - eye));
    camera.ev100_override = 5.0f;
    return camera;
}

MaterialId add_half_transparent(Scene& scene) {
    Material sheet = lambert({0.6f, 0.6f, 0.6f});
    sheet.alpha_mode = AlphaMode::blend;
    sheet.opacity = 0.5f;
    sheet.two_sided = true;
    return scene.add_material(sheet);
}

MaterialId add_glass(Scene& scene, float ior) {
    Material glass;
    glass.base_color = glm::vec3(1);
    glass.roughness = 0.1f;
    glass.ior = ior;
    glass.transmission = 1;
    return scene.add_material(glass);
}

MaterialId add_glowing(Scene& scene, glm::vec3 nits) {
    Material glowing = lambert(glm::vec3(0));
    glowing.emission_nits = nits;
    return scene.add_material(glowing);
}

TEST_F(GiGlass, ABlendedSheetIsLitByTheSkyAsThePathTracerSays) {
    Scene scene;
    add_floor(scene, 1, scene.add_material(lambert(glm::vec3(0.2f))));
    add_shape_node(scene, Quad{{-0.5f, 0.5f, -0.5f}, {0, 0, 1}, {1, 0, 0}}, add_half_transparent(scene));
    scene.set_sky({.model = SkyModel::constant, .luminance_nits = glm::vec3(100)});
    use_cone_tracing(scene, 32);
    const Camera camera = facing({0, 2, 0.01f}, {0, 0.5f, 0}, 0.4f);
    const double found = mean_luminance(cone_traced(scene, camera, picture_size, 4).image);
    const double truth = mean_luminance(path_traced(scene, camera, picture_size, 256, 0, {}).image);
    EXPECT_NEAR(found / truth, 1.0, 0.02);
}

TEST_F(GiGlass, ABlendedSheetBesideAColouredWallTakesOnItsLight) {
    Scene scene;
    add_shape_node(scene, Quad{{-0.6f, 0, -1}, {0, 2, 0}, {0, 0, 2}}, add_glowing(scene, {90, 20, 10}));
    add_shape_node(scene, Quad{{-0.6f, 0, -1}, {1.6f, 0, 0}, {0, 2, 0}}, scene.add_material(lambert(glm::vec3(0.1f))));
    add_shape_node(scene, Quad{{-0.5f, 0.5f, 0}, {1, 0, 0}, {0, 1, 0}}, add_half_transparent(scene));
    use_cone_tracing(scene, 64);
    const Camera camera = facing({0, 1, 2.5f}, {0, 1, 0}, 0.45f);
    const Image found = cone_traced(scene, camera, picture_size, 8).image;
    const Image truth = path_traced(scene, camera, picture_size, 512, 0, {}).image;
    for (const double x : {0.15, 0.5})
        EXPECT_NEAR(middle(found, x, x + 0.35) / middle(truth, x, x + 0.35), 1.0, 0.1) << "from " << x;
}

TEST_F(GiGlass, AGlassBallTurnsWhatIsBehindItRound) {
    Scene scene;
    // Left of the middle the wall glows, right of it it is black.
    add_shape_node(scene, Quad{{-4, -4, -3}, {4, 0, 0}, {0, 8, 0}}, add_glowing(scene, glm::vec3(50)));
    add_shape_node(scene, Sphere{{0, 0, 0}, 0.6f}, add_glass(scene, 1.5f));
    use_cone_tracing(scene, 64);
    const Camera camera = facing({0, 0, 4}, {0, 0, 0}, 0.6f);
    const Image found = cone_traced(scene, camera, picture_size, 4).image;
    const Image truth = path_traced(scene, camera, picture_size, 256, 0, {}).image;
    EXPECT_GT(middle(found, 0.6, 0.8), 20 * middle(found, 0.2, 0.4));
    double error = 0, light = 0;
    for (int y = picture_size * 2 / 5; y < picture_size * 3 / 5; ++y)
        for (int x = 0; x < picture_size; ++x) {
            error += std::abs(units::luminance(found.rgb(x, y) - truth.rgb(x, y)));
            light += units::luminance(truth.rgb(x, y));
        }
    EXPECT_LE(error / light, 0.06) << "a cone that bends on entry alone: 0.19";
}

TEST_F(GiGlass, WhatAHeavyGlassTrapsItGivesBackFromEverywhere) {
    // Before a glowing wall; glass of index 3 lets light out only within 19° of its normal.
    Scene scene;
    add_shape_node(scene, Quad{{-1, 0, -1}, {2, 0, 0}, {0, 2, 0}}, add_glowing(scene, glm::vec3(50)));
    const MaterialId dark = scene.add_material(lambert(glm::vec3(0.2f)));
    add_floor(scene, 1, dark);
    Transform turned;
    turned.rotation = rotation_from_euler_deg({35, 0, 45});
    turned.translation = {0, 1, 0};
    add_shape_node(scene, Box{glm::vec3(-0.25f), glm::vec3(0.25f)}, add_glass(scene, 3.0f), turned);
    use_cone_tracing(scene, 64);
    const Camera camera = facing({0, 1, 3}, {0, 1, 0}, 0.3f);
    const double found = middle(cone_traced(scene, camera, picture_size, 4).image, 0.3, 0.7);
    const double truth = middle(path_traced(scene, camera, picture_size, 256, 0, {}).image, 0.3, 0.7);
    EXPECT_NEAR(found / truth, 1.0, 0.1) << "a cone that bends on entry alone: 1.22";
}

TEST_F(GiGlass, APaneOfGlassShowsWhatIsBehindIt) {
    Scene scene;
    add_shape_node(scene, Quad{{-1, 0, -1}, {2, 0, 0}, {0, 2, 0}}, add_glowing(scene, glm::vec3(50)));
    add_shape_node(scene, Box{{-0.5f, 0.5f, 0}, {0.5f, 1.5f, 0.01f}}, add_glass(scene, 1.5f));
    use_cone_tracing(scene, 64);
    const Camera camera = facing({0, 1, 3}, {0, 1, 0}, 0.3f);
    const double found = mean_luminance(cone_traced(scene, camera, picture_size, 4).image);
    const double truth = mean_luminance(path_traced(scene, camera, picture_size, 256, 0, {}).image);
    EXPECT_NEAR(found / truth, 1.0, 0.02) << "a cone that bends on entry alone: 1.04";
}

}  // namespace
}  // namespace heliodon::tests
