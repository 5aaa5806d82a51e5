// Nested cascades about the camera: large scenes without more voxels.
#include "gi_live.h"
#include "scene/procedural.h"

namespace heliodon::tests {
namespace {

class GiCascades : public LiveFrames {
protected:
    /// Mean of a few samples of a still picture.
    std::vector<float> still(Renderer& renderer, const Scene& scene, const Camera& camera, int size, int samples = 4) {
        if (auto updated = renderer->update(scene); !updated) throw std::runtime_error(updated.error().text());
        expect(renderer->resize(size, size, false));
        for (int i = 0; i < samples; ++i) {
            realtime::FrameSample sample;
            sample.index = static_cast<std::uint32_t>(i);
            sample.count = static_cast<std::uint32_t>(samples);
            sample.replace = i == 0;
            sample.cone_traced = true;
            expect(renderer->render(camera, sample));
        }
        auto sum = renderer->read_sum();
        if (!sum) throw std::runtime_error(sum.error().text());
        for (float& value : *sum) value /= static_cast<float>(samples);
        return std::move(*sum);
    }
    /// Mean relative error of luminance.
    double error_of(Scene& scene, const Camera& camera, int size, const Picture& truth, int voxels, int cascades) {
        use_cascades(scene, voxels, cascades);
        Renderer renderer = new_renderer();
        const auto picture = still(renderer, scene, camera, size);
        double sum = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const float* p = &picture[4 * static_cast<std::size_t>(y * size + x)];
                const double expected = units::luminance(truth.image.rgb(x, y));
                sum += std::abs(units::luminance(glm::vec3(p[0], p[1], p[2])) / expected - 1);
            }
        const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        save(name + "-" + std::to_string(voxels) + "-" + std::to_string(cascades), picture, size, camera);
        if (prints_accuracy_table())
            std::printf("| %s | %d cascades of %d³ | mean error %.2f %% |\n", name.c_str(), cascades, voxels, 100 * sum / (size * size));
        return sum / (size * size);
    }
    static Picture path_traced(const Scene& scene, const Camera& camera, int size, int samples) {
        PathTracer tracer;
        if (auto updated = tracer.update(scene); !updated) throw std::runtime_error(updated.error().text());
        PathOptions options;
        options.width = options.height = size;
        options.samples_per_pixel = samples;
        auto picture = tracer.render(scene, camera, options);
        if (!picture) throw std::runtime_error(picture.error().text());
        return std::move(*picture);
    }
    /// HELIODON_TEST_PICTURES names a folder for pictures to be looked at.
    static void save(const std::string& name, Picture picture) {
        const char* folder = std::getenv("HELIODON_TEST_PICTURES");
        if (!folder || !*folder) return;
        for (float& value : picture.image.pixels)
            value = shading::srgb_encode_rgb(shading::tone_hable(glm::vec3(value) * shading::exposure_scale(picture.ev100), shading::hable_white)).x;
        picture.layers.clear();
        expect(write_picture(std::filesystem::path(folder) / (name + ".png"), picture));
    }
    static void save(const std::string& name, const std::vector<float>& rgba, int size, const Camera& camera) {
        Picture picture{Image(size, size, 3), {}, camera.ev100(), true};
        for (std::size_t i = 0; i < rgba.size(); ++i)
            if (i % 4 != 3) picture.image.pixels[i / 4 * 3 + i % 4] = rgba[i];
        save(name, std::move(picture));
    }
    static void use_cascades(Scene& scene, int voxels, int cascades, int bounces = 0) {
        use_cone_tracing(scene, voxels);
        change_settings(scene, [&](RenderSettings& s) { s.cascades = cascades, s.bounces = bounces, s.shadow_map_size = 512; });
    }
    static Camera looking(glm::vec3 eye, glm::vec3 target) {
        Camera camera;
        camera.position = eye;
        camera.target = target;
        camera.vertical_fov_rad = 1.4f;
        camera.ev100_override = 4.0f;
        return camera;
    }
};

/// A hall with a few turned crates and a knot, and a crate that moves.
struct Hall {
    Scene scene;
    NodeId moving;

    Hall() {
        const MaterialId white = scene.add_material(lambert(glm::vec3(0.6f)));
        add_room(scene, {-8, 0, -8}, {8, 6, 8}, white);
        for (int i = 0; i < 6; ++i) {
            const float t = static_cast<float>(i);
            add_shape_node(scene, Box{glm::vec3(-0.5f), glm::vec3(0.5f)}, scene.add_material(lambert({0.2f + 0.1f * t, 0.5f, 0.4f})),
                           {.translation = {-5 + 2 * t, 0.5f + 0.1f * t, 3 - 1.3f * t}, .rotation = rotation_from_euler_deg({5 * t, 20 * t, 3 * t})});
        }
        Geometry knot;
        knot.mesh = torus_knot_mesh(2, 3, 1.2f, 0.2f, 200);
        Node node;
        node.transform.translation = {0.3f, 2, 0.2f};
        node.parts.push_back({scene.add_geometry(std::move(knot)), white});
        scene.add_node(std::move(node));
        moving = add_shape_node(scene, Box{glm::vec3(-0.3f), glm::vec3(0.3f)}, white, {.translation = {1, 1, 1}});
        add_point_light(scene, {0, 4, 0}, glm::vec3(300));
    }
};

TEST_F(GiCascades, WhereTheCameraGoesVoxelsThatEnterAreVoxelizedAndTheSumsAreThoseOfAll) {
    Hall hall;
    use_cascades(hall.scene, 32, 4, 1);
    Renderer live = new_renderer();
    const std::vector<glm::vec3> eyes{{0.1f, 1.6f, 0.2f}, {0.4f, 1.6f, 0.2f}, {0.9f, 1.2f, -0.5f}, {2.5f, 2.5f, -0.6f},
                                      {2.4f, 2.4f, -0.7f}, {-4, 2, 3}, {-4.3f, 2.1f, 3.4f}};
    int step = 0;
    for (const glm::vec3 eye : eyes) {
        if (++step == 4) hall.scene.set_transform(hall.moving, {.translation = {1.1f, 1.1f, 0.8f}});
        if (step == 6) hall.scene.set_transform(hall.moving, {.translation = {-3, 1.2f, 2}});
        const Camera camera = looking(eye, {0, 1, 0});
        const auto next = frame(live, hall.scene, camera);
        Renderer fresh = new_renderer();
        const auto expected = frame(fresh, hall.scene, camera);
        EXPECT_EQ(difference(next, expected), 0) << step;
        for (int c = 0; c < 4; ++c) EXPECT_EQ(records(live, c), records(fresh, c)) << "step " << step << ", cascade " << c;
    }
    EXPECT_GE(live->voxels().work().entered, 6);
}

TEST_F(GiCascades, AStepOfTheCameraCostsAFractionOfVoxelizingAll) {
    Hall hall;
    Geometry knot;
    knot.mesh = torus_knot_mesh(3, 4, 2.5f, 0.3f, 1500);
    ASSERT_GE(knot.mesh.triangle_count(), 150'000u);
    Node node;
    node.transform.translation = {0.3f, 2, 0.2f};
    node.parts.push_back({hall.scene.add_geometry(std::move(knot)), hall.scene.add_material(lambert(glm::vec3(0.5f)))});
    hall.scene.add_node(std::move(node));
    use_cascades(hall.scene, 64, 3, 1);
    Renderer live = new_renderer();
    frame(live, hall.scene, looking({0, 1.6f, 0}, {0, 1, 3}), 8);
    const auto voxelize = [&](Revoxelize revoxelize) {
        change_settings(hall.scene, [&](RenderSettings& s) { s.revoxelize = revoxelize; });
        frame(live, hall.scene, looking({0, 1.6f, 0}, {0, 1, 3}), 8);
        double sum = 0;
        for (int step = 1; step < 5; ++step) {
            realtime::PassTimes times;
            frame(live, hall.scene, looking({0.15f * static_cast<float>(step), 1.6f, 0}, {0, 1, 3}), 8, &times);
            sum += milliseconds(times, "voxelize");
        }
        return sum / 4;
    };
    const double all = voxelize(Revoxelize::always), entered = voxelize(Revoxelize::changed);
    if (prints_accuracy_table()) std::printf("| a step of the camera: all %.2f ms, what enters %.2f ms, ratio %.3f |\n", all, entered, entered / all);
    EXPECT_LT(entered, 0.7 * all);
}

TEST_F(GiCascades, ARoomThatGlowsEvenlyIsAsBrightWithAnyNumberOfCascades) {
    const int voxels = std::getenv("HELIODON_FULL") ? 64 : 32;
    double one = 0;
    for (const int cascades : {1, 3, 5}) {
        Scene scene;
        Material glowing = lambert(glm::vec3(0.5f));
        glowing.emission_nits = {10, 20, 30};
        add_room(scene, {-1, 0, -1}, {1, 1.5f, 1.2f}, scene.add_material(glowing));
        use_cascades(scene, voxels, cascades);
        change_settings(scene, [](RenderSettings& s) { s.vct.cones = 36; });
        Renderer renderer = new_renderer();
        constexpr int size = 16;
        const auto picture = still(renderer, scene, looking({-0.5f, 0.3f, 0.6f}, {-1, 0.2f, -1}), size, 2);
        double ratio = 0;
        for (std::size_t i = 0; i < picture.size(); ++i)
            if (i % 4 != 3) ratio += picture[i] / (2.0 * glowing.emission_nits[static_cast<int>(i % 4)]) / (3 * size * size);
        if (prints_accuracy_table()) std::printf("| furnace, %d cascades of %d³ | mean %+.2f %% |\n", cascades, voxels, 100 * (ratio - 1));
        EXPECT_NEAR(ratio, 1, 0.05) << cascades;
        if (cascades == 1) one = ratio;
        EXPECT_NEAR(ratio, one, 0.01) << cascades;
    }
}

/// A room of 12 m with small things near the camera, lit by a lamp: what one grid of few voxels shows coarsely.
struct NearThings {
    Scene scene;
    Camera camera;
    NearThings() {
        const MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));
        const MaterialId red = scene.add_material(lambert({0.7f, 0.1f, 0.08f}));
        add_room(scene, {-6, 0, -6}, {6, 5, 6}, white);
        add_shape_node(scene, Box{{-0.15f, 0, -0.14f}, {-0.03f, 0.27f, 0.03f}}, red);
        add_shape_node(scene, Box{{0.03f, 0, -0.09f}, {0.15f, 0.12f, 0.03f}}, white, {.rotation = rotation_from_euler_deg({0, 25, 0})});
        add_shape_node(scene, Box{{-0.45f, 0, -0.27f}, {0.45f, 0.48f, -0.24f}}, white);
        add_point_light(scene, {0.24f, 0.48f, 0.27f}, glm::vec3(6));
        camera.position = {0.03f, 0.24f, 0.39f};
        camera.target = {0, 0.1f, -0.12f};
        camera.vertical_fov_rad = 1.0f;
        camera.ev100_override = 5.0f;
    }
};

TEST_F(GiCascades, NearTheCameraCascadesAreNearerToThePathTracerThanOneGrid) {
    NearThings things;
    constexpr int size = 32;
    const Picture truth = path_traced(things.scene, things.camera, size, 256);
    const auto error = [&](int voxels, int cascades) { return error_of(things.scene, things.camera, size, truth, voxels, cascades); };
    save("near-truth", truth);
    const double one = error(64, 1), nested = error(64, 3);
    EXPECT_LT(nested, one);
    if (std::getenv("HELIODON_FULL")) { EXPECT_LT(nested, 1.2 * error(256, 1)); }
}

TEST_F(GiCascades, AScene1KilometreWideIsNearerToThePathTracerThanWithOneGrid) {
    if (!std::getenv("HELIODON_FULL")) GTEST_SKIP() << "at full size only";
    Scene scene;
    scene.set_sky({.model = SkyModel::constant, .luminance_nits = {4000, 5000, 7000}});
    add_floor(scene, 500, scene.add_material(lambert({0.35f, 0.33f, 0.3f})));
    const std::array<MaterialId, 2> walls{scene.add_material(lambert(glm::vec3(0.7f))), scene.add_material(lambert({0.6f, 0.2f, 0.12f}))};
    for (int i = 0; i < 24; ++i) {
        const glm::vec3 corner((i % 2 ? 10.0f : -32.0f) + static_cast<float>(i % 5), 0, 60 - 12.0f * static_cast<float>(i));
        add_shape_node(scene, Box{corner, corner + glm::vec3(22, 8 + static_cast<float>(7 * i % 23), 10)}, walls[i / 2 % 2]);
    }
    add_sun(scene, {-0.7f, -0.8f, -0.35f}, {60000, 56000, 50000});
    Camera camera = looking({0, 12, 40}, {2, 6, 0});
    camera.ev100_override = 14.0f;
    constexpr int size = 32;
    const Picture truth = path_traced(scene, camera, size, 256);
    save("kilometre-truth", truth);
    const double nested = error_of(scene, camera, size, truth, 64, 5);  // measured: 10.3 %, one grid: 12.3 %
    EXPECT_LT(nested, error_of(scene, camera, size, truth, 64, 1));
    EXPECT_LT(nested, 0.11);
}

TEST_F(GiCascades, SmallStepsOfTheCameraChangeThePointsLightLittle) {
    NearThings things;
    use_cascades(things.scene, 64, 3);
    Renderer live = new_renderer();
    // The same point of the floor, seen from eyes that pass by; cascades move under way by whole pairs of voxels.
    const glm::vec3 point(0.02f, 0, 0.15f);
    double before = 0, largest = 0;
    const auto base = [&] { return live->voxels().surfaces(0).grid.base; };
    glm::ivec3 first{0};
    for (int step = 0; step < 12; ++step) {
        const glm::vec3 eye(-0.5f + 0.08f * static_cast<float>(step), 0.24f, 0.39f);
        Camera camera = looking(eye, point);
        camera.vertical_fov_rad = 0.01f;
        std::vector<float> picture;
        for (int i = 0; i < (step == 0 ? 30 : 1); ++i) picture = frame(live, things.scene, camera, 4, nullptr, shading::frame_aov_indirect);
        if (step == 0) first = base();
        for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(base()[axis] % 2, 0);
        const double light = mean(picture);
        if (step > 0) largest = std::max(largest, std::abs(light / before - 1));
        ASSERT_GT(light, 0);
        before = light;
    }
    EXPECT_NE(base(), first);
    if (prints_accuracy_table()) std::printf("| a step of 8 cm | a point's indirect light of %.3f cd/m² changes by %.3f %% at most |\n", before, 100 * largest);
    EXPECT_LT(largest, 0.02);
}

}  // namespace
}  // namespace heliodon::tests
