#include "passes/compute_raster/compute_raster.h"

#include <numeric>

#include "engine_parity.h"
#include "import/import.h"
#include "passes/cull/cull.h"
#include "realtime/camera_frame.h"
#include "scene/procedural.h"
#include "shared_data.h"
#include "voxel_test.h"

namespace heliodon::tests {
namespace {

using Ids = std::vector<glm::uvec2>;

/// What each pixel sees, by either rasterizer, under validation.
class ComputeRaster : public ::testing::Test {
protected:
    static constexpr std::uint32_t width = 320, height = 240;

    static void SetUpTestSuite() {
        gpu::InstanceSettings settings;
        settings.validation = true;
        gpu::DeviceSettings device_settings;
        device_settings.pipeline_cache_directory = "";
        device_ = value_of(gpu::Device::create(value_of(gpu::Instance::create(settings)), device_settings));
        pipelines_ = std::make_unique<gpu::Pipelines>(*device_, gpu::ShaderLibrary(passes::embedded_shaders()));
    }
    static void TearDownTestSuite() {
        pipelines_.reset();
        device_.reset();
    }
    void SetUp() override {
        if (!passes::can_raster_by_compute(*device_, width * height)) GTEST_SKIP() << "no 64-bit atomics";
    }
    void TearDown() override {
        value_of(device_->wait_idle());
        for (const auto& message : device_->validation_messages()) ADD_FAILURE() << message;
    }

    struct Seen {
        Ids compute, hardware;
    };
    struct Room {
        std::uint32_t large = 1 << 16, strips = 1 << 18;
    };
    Seen see(const Scene& scene, const Camera& camera) { return see(scene, camera, Room{}); }
    Seen see(const Scene& scene, const Camera& camera, const Room& room) {
        realtime::GpuScene gpu_scene(*device_);
        value_of(gpu_scene.update(scene));
        passes::SceneInputs tables;
        gpu_scene.append_bindings(tables.tables);
        tables.index_buffer = &gpu_scene.index_buffer();
        tables.instance_count = gpu_scene.instance_count();
        tables.has_tested = gpu_scene.has_tested();

        passes::ComputeRasterInputs inputs;
        inputs.large_capacity = room.large;
        inputs.strip_capacity = room.strips;
        inputs.tests_opacity = tables.has_tested;
        std::vector<passes::TriangleRange> ranges;
        const auto instances = gpu_scene.flat().instances();
        for (std::uint32_t i = 0; i < instances.size(); ++i) {
            ranges.push_back({inputs.triangle_count, i});
            inputs.triangle_count +=
                static_cast<std::uint32_t>(gpu_scene.flat().geometries()[instances[i].geometry]->mesh.triangle_count());
        }
        inputs.range_count = static_cast<std::uint32_t>(ranges.size());
        const glm::mat4 world_to_clip =
            realtime::camera_frame(camera, gpu_scene.bounds(), width, height, glm::vec2(0)).world_to_clip;
        std::vector<shading::RasterView> views{passes::raster_view(world_to_clip, {0, 0}, {width, height}, 0, 0)};
        inputs.batches = passes::raster_batches(views, passes::raster_key_capacity(*device_, width * height));
        const auto filled = [&](const char* name, const auto& values) {
            auto buffer = value_of(gpu::Buffer::create(*device_, {name, values.size() * sizeof(values[0])}));
            value_of(device_->upload(buffer, std::as_bytes(std::span(values))));
            return buffer;
        };
        const gpu::Buffer range_buffer = filled("ranges", ranges), view_buffer = filled("views", views);
        const gpu::Buffer cull_views = filled("cull views", std::vector<shading::ViewData>{{world_to_clip}});
        inputs.triangle_ranges = &range_buffer;
        inputs.views = &view_buffer;

        graph::Graph graph;
        const VkExtent2D extent{width, height};
        const auto computed = value_of(passes::add_visibility_by_compute(graph, *pipelines_, tables, inputs, extent));
        const std::uint32_t view_count = 1;
        const auto lists = value_of(
            passes::add_cull(graph, *pipelines_, tables, {1, tables.instance_count, false}, cull_views, view_count));
        const auto drawn = value_of(passes::add_visibility(graph, *pipelines_, tables, cull_views, lists, extent));
        graph.export_image(computed.ids);
        graph.export_image(drawn.ids);
        graph::Executor executor(*device_);
        value_of(executor.set_graph(graph));
        for (int frame = 0; frame < 2; ++frame) {  // the second finds what the first left
            auto commands = value_of(device_->begin_commands("visibility"));
            value_of(executor.execute(commands));
            value_of(device_->submit(std::move(commands)));
        }
        return {value_of(device_->read_back_as<glm::uvec2>(executor.image(computed.ids))),
                value_of(device_->read_back_as<glm::uvec2>(executor.image(drawn.ids)))};
    }
    static int differences(const Seen& seen) {
        return std::inner_product(seen.compute.begin(), seen.compute.end(), seen.hardware.begin(), 0, std::plus<>(),
                                  std::not_equal_to<>());
    }
    static int empty_pixels(const Ids& ids) {
        return static_cast<int>(std::count_if(ids.begin(), ids.end(), [](glm::uvec2 id) { return id.x == 0; }));
    }

private:
    static inline std::unique_ptr<gpu::Device> device_;
    static inline std::unique_ptr<gpu::Pipelines> pipelines_;
};

Camera camera_at(glm::vec3 position, glm::vec3 target, float fov_rad = 1.0f) {
    Camera camera;
    camera.position = position;
    camera.target = target;
    camera.vertical_fov_rad = fov_rad;
    return camera;
}

/// A sphere and a torus knot of small triangles between walls that pass the camera.
Scene sphere_knot_and_walls() {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));
    add_mesh(scene, tessellate(Sphere{{-1.2f, 1, 0}, 0.8f}, 96), white);
    Transform beside;
    beside.translation = {1.1f, 1.1f, 0.2f};
    add_mesh(scene, torus_knot_mesh(2, 3, 1.0f, 0.2f, 300), white, beside);
    add_floor(scene, 50, white);
    add_shape_node(scene, Quad{{-3, -1, -40}, {0, 0, 80}, {0, 9, 0}}, white);
    add_shape_node(scene, Quad{{3, -1, -40}, {0, 9, 0}, {0, 0, 80}}, white);
    return scene;
}

TEST_F(ComputeRaster, EveryPixelSeesTheTriangleThatTheHardwareSees) {
    const Scene scene = sphere_knot_and_walls();
    for (const Camera& camera :
         {camera_at({0, 1.3f, 4}, {0, 1, 0}), camera_at({2.99f, 0.02f, 2}, {-1, 0.5f, 0}, 1.5f),
          camera_at({0.3f, 0.001f, 3}, {0, 0.4f, 0}, 2.2f), camera_at({-1.2f, 1, 0}, {1, 1, 0.2f})}) {
        const Seen seen = see(scene, camera);
        EXPECT_LE(differences(seen), int(width * height / 1000));
        RecordProperty("differences", differences(seen));
    }
}

TEST_F(ComputeRaster, WithoutRoomForLargeTrianglesThePictureIsTheSame) {
    const Scene scene = sphere_knot_and_walls();
    const Camera camera = camera_at({2.99f, 0.02f, 2}, {-1, 0.5f, 0}, 1.5f);
    const Seen roomy = see(scene, camera);
    EXPECT_EQ(see(scene, camera, {.strips = 3}).compute, roomy.compute);
    EXPECT_EQ(see(scene, camera, {.large = 2}).compute, roomy.compute);
}

TEST_F(ComputeRaster, AClosedMeshSeenFromInsideCoversEveryPixel) {
    Scene scene;
    add_mesh(scene, tessellate(Sphere{{0, 0, 0}, 2}, 360), scene.add_material(lambert(glm::vec3(1))));
    for (int i = 0; i < 4; ++i) {
        const float angle = 0.7f * static_cast<float>(i);
        const glm::vec3 eye(0.3f * i, 0.2f, -0.1f * i);
        const Seen seen = see(scene, camera_at(eye, eye + glm::vec3(std::cos(angle), 0.4f * i, std::sin(angle)), 1.4f));
        EXPECT_EQ(empty_pixels(seen.compute), 0);
    }
}

TEST_F(ComputeRaster, ARoomThatTheCameraStandsInHasNoGapAtItsEdges) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(1)));
    add_shape_node(scene, Box{{-3, -1, -20}, {2, 1.5f, 30}}, white);
    for (const glm::vec3 target :
         {glm::vec3(2, 1.5f, -20), glm::vec3(-3, -1, 2.1f), glm::vec3(0, -1, 1.99f), glm::vec3(1.999f, 1.49f, 2.1f)}) {
        const Seen seen = see(scene, camera_at({1.99f, 1.45f, 2}, target, 1.9f));
        EXPECT_EQ(empty_pixels(seen.compute), 0);
        EXPECT_LE(differences(seen), int(width * height / 1000));
    }
}

TEST_F(ComputeRaster, TheNearerSurfaceHidesTheOther) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(1)));
    for (int i = 0; i < 40; ++i)  // in an order that has nothing to do with their distance
        add_shape_node(scene, Quad{{-0.1f * i, -1, -0.05f * ((i * 17) % 40)}, {2, 0, 0}, {0, 2, 0}}, white);
    const Seen seen = see(scene, camera_at({0, 0, 3}, {0, 0, 0}));
    EXPECT_LE(differences(seen), int(width * height / 1000));
}

/// A chessboard of n² holes and none; `levels`: with the coarser ones, which are half there.
Texture chessboard(int n, bool levels) {
    Texture texture;
    texture.width = texture.height = n;
    texture.magnify = texture.minify = Filter::nearest;
    texture.mipmapped = levels;
    texture.opaque = false;
    for (int size = n; size >= 1; size /= 2) {
        auto& level = texture.levels.emplace_back();
        for (int i = 0; i < size * size; ++i) {
            const int hole = size == n ? ((i + i / n) % 2 ? 255 : 0) : 128;
            for (const int value : {255, 255, 255, hole}) level.push_back(static_cast<std::uint8_t>(value));
        }
        if (!levels) break;
    }
    return texture;
}

TEST_F(ComputeRaster, MaskedSurfacesHaveTheHolesThatTheHardwareFinds) {
    for (const bool levels : {false, true}) {
        Scene scene;
        Material leaf = lambert(glm::vec3(1));
        leaf.alpha_mode = AlphaMode::mask;
        leaf.alpha_cutoff = 0.6f;  // far away, at coarser levels, all is a hole
        leaf.base_color_texture.texture = scene.add_texture(chessboard(levels ? 64 : 8, levels));
        const MaterialId masked = scene.add_material(leaf);
        Mesh sheet;
        sheet.positions = {{-1, 0, 9}, {1, 0, 9}, {1, 0, -9}, {-1, 0, -9}};
        sheet.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
        sheet.indices = {0, 1, 2, 0, 2, 3};
        add_mesh(scene, sheet, masked);
        add_floor(scene, 3, scene.add_material(lambert(glm::vec3(1))), -0.5f);
        const Seen seen = see(scene, camera_at({0.3f, 1, 4}, {0, 0, 0}));
        const auto pixels_of = [](const Ids& ids, std::uint32_t instance) {
            return std::count_if(ids.begin(), ids.end(), [&](glm::uvec2 id) { return id.x == instance + 1; });
        };
        EXPECT_GT(pixels_of(seen.compute, 0), 1000);
        EXPECT_GT(pixels_of(seen.compute, 1), 1000);
        EXPECT_LE(differences(seen), int(width * height / 1000));
    }
}

TEST(RasterBatches, HoldAsManyViewsAsThereIsRoomForInTheirOrder) {
    std::vector<shading::RasterView> views;
    for (const std::uint32_t size : {32, 16, 24, 40, 40, 8})
        views.push_back(passes::raster_view(glm::mat4(1), {0, 0}, glm::uvec2(size), 0, 0));
    const auto batches = passes::raster_batches(views, 2000);
    ASSERT_EQ(batches.size(), 3u);
    const std::uint32_t first[] = {0, 3, 4}, count[] = {3, 1, 2}, keys[] = {1024 + 256 + 576, 1600, 1600 + 64},
                        tiles[] = {4 + 1 + 4, 9, 9 + 1};
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(batches[i].view_first, first[i]);
        EXPECT_EQ(batches[i].view_count, count[i]);
        EXPECT_EQ(batches[i].key_count, keys[i]);
        EXPECT_EQ(batches[i].tile_count, tiles[i]);
    }
    EXPECT_EQ(views[2].first_key, 1024u + 256);
    EXPECT_EQ(views[2].first_tile, 5u);
    EXPECT_EQ(views[4].first_key, 0u);
    EXPECT_EQ(views[5].first_tile, 9u);
    EXPECT_TRUE(passes::raster_batches({}, 2000).empty());
}

/// Pictures by either rasterizer.
class RasterizerPictures : public EngineParity {
protected:
    void set(Scene& scene, Rasterizer rasterizer, int shadow_map_size) {
        RenderSettings settings = scene.render_settings();
        settings.rasterizer = rasterizer;
        settings.shadow_map_size = shadow_map_size;
        scene.set_render_settings(settings);
    }
    double flip_between_rasterizers(Scene& scene, const Camera& camera, int size, int samples, int shadow_map_size) {
        const RealtimeOptions options{.width = size, .height = size, .samples = samples};
        RealtimeStatistics statistics;
        set(scene, Rasterizer::hardware, shadow_map_size);
        const Picture hardware = render(scene, camera, options, &statistics);
        const int draws = statistics.draw_calls;
        set(scene, Rasterizer::compute, shadow_map_size);
        const Picture computed = render(scene, camera, options, &statistics);
        EXPECT_LT(statistics.draw_calls, draws);
        const double flip = value_of(compare(hardware.image, computed.image, hardware.ev100)).flip;
        RecordProperty("flip", std::to_string(flip));
        return flip;
    }
};

TEST_F(RasterizerPictures, ShadowsAreTheHardwares) {
    Scene scene = sphere_knot_and_walls();
    add_point_light(scene, {0.2f, 2.5f, 1.5f}, glm::vec3(30, 25, 20));
    add_sun(scene, {0.2f, -1, -0.3f}, glm::vec3(20));
    Node spot;
    spot.transform.translation = {0, 2.5f, 3};
    spot.transform.rotation = rotation_from_euler_deg({-30, 10, 0});
    spot.light = Light{.type = LightType::spot, .intensity = {20, 20, 60}, .inner_rad = 0.26f, .outer_rad = 0.44f};
    scene.add_node(spot);
    Camera camera = camera_at({0, 1.3f, 4}, {0, 1, 0});
    camera.ev100_override = 2.0f;
    EXPECT_LE(flip_between_rasterizers(scene, camera, 256, 1, 2048), 0.005);
}

TEST_F(RasterizerPictures, BlendedSurfacesCastTheHardwaresShadows) {
    Scene scene;
    add_floor(scene, 2, scene.add_material(lambert(glm::vec3(0.8f))));
    Material glass = lambert(glm::vec3(0.5f));
    glass.alpha_mode = AlphaMode::blend;
    glass.opacity = 0.4f;
    glass.two_sided = true;
    add_shape_node(scene, Quad{{-1, 0.7f, -1}, {0, 0, 1.3f}, {1.5f, 0, 0}}, scene.add_material(glass));
    add_point_light(scene, {0.3f, 2, 0.2f}, glm::vec3(20));
    Camera camera = camera_at({0, 1.5f, 3}, {0, 0, 0});
    camera.ev100_override = 2.0f;
    EXPECT_LE(flip_between_rasterizers(scene, camera, 128, 2, 128), 0.005);
}

TEST_F(RasterizerPictures, TheCornellBoxIsWhatThePathTracerSays) {
    const auto path = shared_path("scenes/cornell-point.heliodon.json");
    if (!path) GTEST_SKIP() << "no shared data";
    Warnings warnings;
    auto scene = load_scene(*path, {}, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    set(*scene, Rasterizer::compute, 1024);
    expect_agreement(*scene, {.realtime_samples = 32}, {0.0005, 0.0005, 0.005});
}

TEST_F(RasterizerPictures, ManySmallShadowMapsOfDifferentSizesAreTheHardwares) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.8f)));
    add_floor(scene, 3, white);
    add_shape_node(scene, Box{{-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}}, white);
    for (int i = 0; i < 40; ++i)
        add_point_light(scene, {2 * std::cos(0.7f * i), 0.5f + 0.05f * i, 2 * std::sin(0.7f * i)},
                        glm::vec3(0.3f + 0.1f * i));
    Camera camera = camera_at({0, 3, 3}, {0, 0, 0});
    camera.ev100_override = 2.0f;
    EXPECT_LE(flip_between_rasterizers(scene, camera, 128, 1, 512), 0.005);
}

}  // namespace
}  // namespace heliodon::tests
