// Cones that share the hemisphere among a still picture's samples, against the path tracer.
#include "gi_shared_scene.h"

namespace heliodon::tests {
namespace {

class GiNarrow : public GlobalIllumination {
protected:
    static void narrow_cones(Scene& scene) {
        RenderSettings settings = scene.render_settings();
        settings.vct.narrow = true;
        scene.set_render_settings(settings);
    }
};

TEST_F(GiNarrow, TheyAreNearerToThePathTracerThanWideOnesInTheCornellBoxUnderAPointLight) {
    auto box = cornell_box_under_a_point_light();
    if (!box) GTEST_SKIP() << "no shared data";
    constexpr int size = 128, samples = 16;
    const auto error = [&] {
        const Image image = cone_traced(box->scene, box->camera, size, samples).image;
        const auto metrics = compare(box->reference.image, image, box->reference.ev100);
        if (!metrics) ADD_FAILURE() << metrics.error().text();
        return metrics ? double(metrics->flip) : 1.0;
    };
    const double wide = error();
    narrow_cones(box->scene);
    const double narrow = error();
    RecordProperty("wide", std::to_string(wide));
    RecordProperty("narrow", std::to_string(narrow));
    EXPECT_LT(narrow, 0.9 * wide);
}

TEST_F(GiNarrow, ASingleSampleHasTheWholeHemisphereAndChangesNothing) {
    Scene scene;
    add_floor(scene, 1, scene.add_material(lambert(glm::vec3(0.5f))));
    add_shape_node(scene, Box{{-0.2f, 0, -0.2f}, {0.2f, 0.5f, 0.2f}}, scene.add_material(lambert(glm::vec3(0.5f))));
    scene.set_sky({.model = SkyModel::constant, .luminance_nits = glm::vec3(100)});
    use_cone_tracing(scene, 32);
    RenderSettings settings = scene.render_settings();
    settings.bounces = 1;
    scene.set_render_settings(settings);
    Camera camera;
    camera.position = {0, 2, 2};
    camera.ev100_override = 5.0f;
    const Image wide = cone_traced(scene, camera, 32, 1).image;
    narrow_cones(scene);
    EXPECT_EQ(cone_traced(scene, camera, 32, 1).image.pixels, wide.pixels);
}

}  // namespace
}  // namespace heliodon::tests
