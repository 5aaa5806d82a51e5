// Shadow volumes: sharp shadows of the sun, the same as rays find them. With HELIODON_FULL set, in pictures of full
// size and with the map's own size.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "import/import.h"
#include "realtime/camera_frame.h"
#include "shared_data.h"
#include "test_scenes.h"
#include "trace/embree_scene.h"

namespace heliodon::tests {
namespace {

const bool full_size = std::getenv("HELIODON_FULL") != nullptr;
const int width = full_size ? 1024 : 192, height = full_size ? 768 : 144;

/// Every surface white, opaque, faceted and lit on both sides, every shape its tessellation: what reaches a pixel then
/// depends on the sun's visibility alone.
void make_judgeable(Scene& scene, SunShadows shadows = SunShadows::volumes) {
    std::vector<MaterialId> materials;
    scene.materials().each([&](MaterialId id, const Material&) { materials.push_back(id); });
    Material white = lambert(glm::vec3(0.8f));
    white.two_sided = true;
    for (const MaterialId id : materials) scene.set_material(id, white);
    std::vector<std::pair<GeometryId, Geometry>> geometries;
    scene.geometries().each([&](GeometryId id, const Geometry& geometry) { geometries.emplace_back(id, geometry); });
    for (auto& [id, geometry] : geometries) {
        geometry.shape.reset();
        geometry.mesh.normals = {};
        geometry.mesh.tangents = {};
        scene.set_geometry(id, std::move(geometry));
    }
    std::vector<NodeId> lights;
    scene.nodes().each([&](NodeId id, const Node& node) {
        if (node.light && node.light->type != LightType::directional) lights.push_back(id);
    });
    for (const NodeId id : lights) scene.set_light(id, std::nullopt);
    RenderSettings settings = scene.render_settings();
    settings.gi = "none";
    settings.sun_shadows = shadows;
    if (!full_size) settings.shadow_volumes.map_size = 256;
    scene.set_render_settings(settings);
}

/// What rays say of the pixels' centres.
class Truth {
public:
    explicit Truth(const Scene& scene) {
        const auto changes = flat_.update(scene);
        const auto updated = tracer_.update(flat_, changes);
        if (!updated) ADD_FAILURE() << updated.error().text();
        for (const shading::LightData& light : flat_.lights())
            if (light.type == shading::light_type_directional) sun_ = light.axis;
    }
    enum class Pixel { background, averted, shadowed, lit };
    [[nodiscard]] Pixel at(const shading::FrameData& frame, int x, int y) const {
        shading::KernelRay ray{};
        ray.origin = frame.position;
        ray.direction = glm::normalize(frame.ray_corner + frame.ray_dx * (x + 0.5f) + frame.ray_dy * (y + 0.5f));
        ray.t_max = 1e30f;
        const shading::KernelHit hit = tracer_.trace(ray);
        if (hit.kind == shading::kernel_hit_nothing) return Pixel::background;
        const shading::InstanceData& instance = flat_.instances()[hit.instance];
        const Mesh& mesh = flat_.geometries()[instance.geometry]->mesh;
        glm::dvec3 p[3];
        double extent = 0;
        for (int i = 0; i < 3; ++i) {
            p[i] = glm::dvec3(glm::dmat4(instance.object_to_world) *
                              glm::dvec4(mesh.positions[mesh.indices[3 * hit.primitive + i]], 1));
            extent = std::max({extent, std::abs(p[i].x), std::abs(p[i].y), std::abs(p[i].z)});
        }
        const glm::dvec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
        glm::dvec3 normal = glm::normalize(glm::cross(e1, e2));
        if (glm::dot(normal, glm::dvec3(ray.direction)) > 0) normal = -normal;
        if (glm::dot(normal, glm::dvec3(sun_)) >= 0) return Pixel::averted;
        const glm::dvec3 point = p[0] + e1 * double(hit.barycentric.x) + e2 * double(hit.barycentric.y);
        ray.origin = glm::vec3(point + normal * (1.5e-6 * extent));  // what rounding moves it
        ray.direction = -sun_;
        ray.kind = shading::kernel_ray_shadow;
        return tracer_.trace(ray).kind == shading::kernel_hit_blocked ? Pixel::shadowed : Pixel::lit;
    }

private:
    convert::FlatScene flat_;
    trace::EmbreeScene tracer_;
    glm::vec3 sun_{0, -1, 0};
};

struct Difference {
    int judged = 0, shadowed = 0;  // pixels that face the sun, and those of them in shadow
    int different = 0;
    int inside = 0;                // of the different ones: no pixel about them is seen otherwise by rays
    [[nodiscard]] double share() const { return double(different) / judged; }
};

class ShadowVolumesTest : public RealtimeTest {
protected:
    /// In a picture of `columns` × `rows` pixels.
    Difference difference(const Scene& scene, const Camera& camera, int columns, int rows,
                          RealtimeStatistics* statistics = nullptr) {
        RealtimeOptions options;
        options.width = columns;
        options.height = rows;
        options.samples = 1;
        options.environment = false;
        const Image image = render(scene, camera, options, statistics).image;
        const Truth truth(scene);
        const auto frame = realtime::camera_frame(camera, scene.bounds(), columns, rows, glm::vec2(0));
        std::vector<Truth::Pixel> seen;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) seen.push_back(truth.at(frame, x, y));
        Difference result;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const Truth::Pixel pixel = seen[y * columns + x];
                if (pixel == Truth::Pixel::background || pixel == Truth::Pixel::averted) continue;
                ++result.judged;
                result.shadowed += pixel == Truth::Pixel::shadowed;
                const bool lit = image.at(x, y) > 0;
                if (lit == (pixel == Truth::Pixel::lit)) continue;
                ++result.different;
                bool inside = true;
                for (int i = 0; i < 9; ++i) {
                    const int u = std::clamp(x + i % 3 - 1, 0, columns - 1), v = std::clamp(y + i / 3 - 1, 0, rows - 1);
                    inside = inside && seen[v * columns + u] == pixel;
                }
                result.inside += inside;
            }
        RecordProperty("pixels", result.judged);
        RecordProperty("in_shadow", result.shadowed);
        RecordProperty("different", result.different);
        RecordProperty("different_away_from_edges", result.inside);
        return result;
    }
};

Camera camera_from(glm::vec3 position, glm::vec3 target, float fov_rad = 0.8f) {
    Camera camera;
    camera.position = position;
    camera.target = target;
    camera.vertical_fov_rad = fov_rad;
    camera.ev100_override = 14.0f;
    return camera;
}

/// Boxes and spheres on and over a floor.
Scene boxes_and_spheres() {
    Scene scene;
    ConvertSettings convert;
    convert.shape_segments = 48;
    scene.set_convert_settings(convert);
    Material named = lambert(glm::vec3(0.8f));
    named.name = "white";
    const MaterialId white = scene.add_material(named);
    add_floor(scene, 6, white);
    const glm::vec3 places[] = {{0, 0, 0}, {1.5f, 0.4f, 0.3f}, {-1.4f, 0, 0.8f}, {-0.4f, 1.2f, 0.2f}, {0.8f, 0, -1.6f}};
    for (int i = 0; i < 5; ++i) {
        Transform transform;
        transform.translation = places[i];
        transform.rotation = rotation_from_euler_deg({0, 25 * i, i == 3 ? 30 : 0});
        if (i % 2 == 0) add_shape_node(scene, Box{{-0.4f, 0, -0.3f}, {0.4f, 0.9f, 0.3f}}, white, transform);
        else add_shape_node(scene, Sphere{{0, 0.4f, 0}, 0.4f}, white, transform);
    }
    add_sun(scene, {-0.55f, -0.8f, -0.35f}, glm::vec3(50000));
    make_judgeable(scene);
    return scene;
}

TEST_F(ShadowVolumesTest, BoxesAndSpheresCastTheShadowsThatRaysFind) {
    const Scene scene = boxes_and_spheres();
    const Difference d = difference(scene, camera_from({-2, 3.2f, -4}, {-0.4f, 0.3f, -0.4f}), width, height);
    EXPECT_LE(d.share(), 1e-3);
    EXPECT_GT(d.shadowed, width * height / 20);
}

TEST_F(ShadowVolumesTest, TheCameraMayStandInAVolumeAndHaveAFarPlane) {
    const Scene scene = boxes_and_spheres();
    // Behind the first box, where the sun does not reach the camera.
    Camera camera = camera_from({-0.5f, 0.25f, -0.35f}, {-3, 0.1f, -2}, 1.4f);
    camera.far_m = 8;
    const Difference d = difference(scene, camera, width, height);
    EXPECT_LE(d.share(), 1e-3);
    EXPECT_GT(d.shadowed, width * height / 20);
}

TEST_F(ShadowVolumesTest, VolumesBehindLitTrianglesCastWhatVolumesBehindAllDoWithFewerSides) {
    Scene scene = boxes_and_spheres();
    // A roof over half of it: what it covers is not lit.
    add_shape_node(scene, Box{{-3, 2.5f, -3}, {0.2f, 2.6f, 3}}, scene.find_material("white"));
    const Camera camera = camera_from({3, 3.2f, 4}, {-1, 0.3f, 0});
    RealtimeOptions options;
    options.width = 160, options.height = 120, options.samples = 1;
    RealtimeStatistics lit, fewest, all;
    const Image of_fewest = render(scene, camera, options, &fewest).image;
    options.volumes_behind = VolumesBehind::lit;
    const Image of_lit = render(scene, camera, options, &lit).image;
    options.volumes_behind = VolumesBehind::all;
    const Image of_all = render(scene, camera, options, &all).image;
    EXPECT_EQ(of_fewest.pixels, of_all.pixels);
    EXPECT_EQ(of_lit.pixels, of_all.pixels);
    ASSERT_TRUE(lit.shadow_volumes && fewest.shadow_volumes && all.shadow_volumes);
    EXPECT_LT(lit.shadow_volumes->caps, all.shadow_volumes->caps);
    EXPECT_LE(lit.shadow_volumes->caps, fewest.shadow_volumes->caps);
    EXPECT_LT(fewest.shadow_volumes->sides, lit.shadow_volumes->sides);
    EXPECT_LT(fewest.shadow_volumes->sides, all.shadow_volumes->sides);
}

TEST_F(ShadowVolumesTest, NoTriangleIsMissedForBeingSmallerThanATexelOfTheMap) {
    Scene scene;
    ConvertSettings convert;
    convert.shape_segments = 128;
    scene.set_convert_settings(convert);
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.8f)));
    add_floor(scene, 6, white);
    add_shape_node(scene, Sphere{{0, 0.7f, 0}, 0.5f}, white);
    add_sun(scene, {-0.55f, -0.8f, -0.35f}, glm::vec3(50000));
    make_judgeable(scene);
    RenderSettings settings = scene.render_settings();
    // A sphere of 16 thousand triangles on a few dozen texels, looked at closer until triangles have four of them, or
    // not.
    for (const float significant_px : {4.0f, 1e-4f}) {
        settings.shadow_volumes = {.map_size = 64, .significant_px = significant_px};
        scene.set_render_settings(settings);
        RealtimeStatistics statistics;
        const Difference d = difference(scene, camera_from({-2, 2, 2}, {-0.2f, 0.3f, 0}), 160, 120, &statistics);
        EXPECT_LE(d.share(), 1e-3);
        EXPECT_GT(d.shadowed, 500);
        ASSERT_TRUE(statistics.shadow_volumes);
        if (significant_px > 1) EXPECT_EQ(statistics.shadow_volumes->parts, 1u);
        else EXPECT_GT(statistics.shadow_volumes->found_by_round.size(), 4u);
    }
}

/// Triangles of corners, three each.
NodeId add_triangles(Scene& scene, MaterialId material, const std::vector<glm::vec3>& corners) {
    Geometry geometry;
    for (const glm::vec3& corner : corners) {
        geometry.mesh.indices.push_back(static_cast<std::uint32_t>(geometry.mesh.positions.size()));
        geometry.mesh.positions.push_back(corner);
    }
    Node node;
    node.parts.push_back({scene.add_geometry(std::move(geometry)), material});
    return scene.add_node(std::move(node));
}

TEST_F(ShadowVolumesTest, OpenInsideOutAndNonManifoldMeshesCastTheirShadows) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.8f)));
    add_floor(scene, 4, white);
    // Its rear to the sun.
    add_shape_node(scene, Quad{{-1.5f, 0.8f, -0.4f}, {1, 0, 0}, {0, 0, 1}}, white);
    Transform mirrored;
    mirrored.scale = {-1, 1, 1};
    add_shape_node(scene, Box{{-1.2f, 0.3f, 0.9f}, {-0.6f, 0.9f, 1.4f}}, white, mirrored);
    // Three wings on one edge, the third the other way round; a T-junction; two triangles through each other.
    const glm::vec3 foot(0.4f, 0.2f, -0.5f), head(0.4f, 1.1f, -0.5f);
    add_triangles(scene, white,
                  {foot, head, {1, 0.6f, -0.5f}, foot, head, {0, 0.6f, 0}, head, foot, {0.2f, 0.6f, -1.1f}});
    add_triangles(scene, white,
                  {{-1, 0.4f, -2},
                   {0, 0.4f, -1},
                   {0, 0.4f, -2},
                   {-1, 0.4f, -2},
                   {-1, 0.4f, -1},
                   {-0.5f, 0.4f, -1.5f},
                   {-1, 0.4f, -1},
                   {0, 0.4f, -1},
                   {-0.5f, 0.4f, -1.5f}});
    add_triangles(
        scene, white,
        {{0, 0.5f, 1}, {0.8f, 0.5f, 1.8f}, {0, 0.9f, 1.8f}, {0, 0.9f, 1}, {0.8f, 0.5f, 1.1f}, {0.6f, 0.5f, 1.9f}});
    add_sun(scene, {0.35f, -0.8f, -0.25f}, glm::vec3(50000));
    make_judgeable(scene);
    const Difference d = difference(scene, camera_from({0.5f, 5, 4.5f}, {0, 0.2f, -0.2f}), width, height);
    EXPECT_LE(d.share(), 1e-3);
    EXPECT_GT(d.shadowed, width * height / 50);
}

TEST_F(ShadowVolumesTest, TrianglesDoNotJoinWhereThatLeavesMoreSides) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.8f)));
    // One triangle twice, under a roof, between two that the sun reaches. Either one alone would leave fewer sides.
    const glm::vec3 a(0, 0, 0), b(1, 0, 0), c(0, 0, 1);
    add_triangles(scene, white, {a, b, c, a, b, c, b, a, {0.5f, 0, -2}, c, b, {2, 0, 2}});
    add_shape_node(scene, Quad{{-0.2f, 0.5f, -0.2f}, {0, 0, 1.4f}, {1.4f, 0, 0}}, white);
    add_sun(scene, {0, -1, 0}, glm::vec3(50000));
    make_judgeable(scene);
    RealtimeOptions options;
    options.width = 64, options.height = 48, options.samples = 1;
    for (const VolumesBehind behind : {VolumesBehind::lit, VolumesBehind::fewest, VolumesBehind::all}) {
        options.volumes_behind = behind;
        RealtimeStatistics statistics;
        render(scene, camera_from({3, 3, 4}, {0.5f, 0, 0}), options, &statistics);
        ASSERT_TRUE(statistics.shadow_volumes);
        EXPECT_EQ(statistics.shadow_volumes->sides, behind == VolumesBehind::all ? 4u + 8u : 4u + 6u);
    }
}

TEST_F(ShadowVolumesTest, VolumesAreMadeAnewWhereSurfacesMoveAndNotForTheCamera) {
    Scene scene = boxes_and_spheres();
    RealtimeOptions options;
    options.width = 64, options.height = 48, options.samples = 1;
    const auto builds = [&](const Camera& camera) {
        RealtimeStatistics statistics;
        render(scene, camera, options, &statistics);
        return statistics.shadow_volumes ? statistics.shadow_volumes->builds : 0;
    };
    EXPECT_EQ(builds(camera_from({3, 2.2f, 4}, {0, 0.5f, 0})), 1u);
    EXPECT_EQ(builds(camera_from({-3, 2.2f, 4}, {0, 0.5f, 0})), 1u);
    NodeId box;
    scene.nodes().each([&](NodeId id, const Node& node) { box = node.light ? box : id; });
    Transform moved;
    moved.translation = {0.5f, 0.2f, -1};
    scene.set_transform(box, moved);
    const Difference d = difference(scene, camera_from({3, 2.2f, 4}, {0, 0.5f, 0}), 128, 96);
    EXPECT_LE(d.share(), 1e-3);
    EXPECT_EQ(builds(camera_from({3, 2.2f, 4}, {0, 0.5f, 0})), 2u);
}

TEST_F(ShadowVolumesTest, MaskedSurfacesCastTheirShadowsByMapsBesideVolumes) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.8f)));
    add_floor(scene, 2, white);
    Material masked = lambert(glm::vec3(0.8f));
    masked.alpha_mode = AlphaMode::mask;
    masked.alpha_cutoff = 0.5f;
    masked.opacity = 0.8f;
    const MaterialId there = scene.add_material(masked);
    masked.opacity = 0.3f;
    const MaterialId cut = scene.add_material(masked);
    add_shape_node(scene, Quad{{-1.2f, 0.5f, -0.3f}, {0, 0, 0.6f}, {0.6f, 0, 0}}, there);
    add_shape_node(scene, Quad{{-0.3f, 0.5f, -0.3f}, {0, 0, 0.6f}, {0.6f, 0, 0}}, cut);
    add_shape_node(scene, Quad{{0.6f, 0.5f, -0.3f}, {0, 0, 0.6f}, {0.6f, 0, 0}}, white);
    add_sun(scene, {0, -1, -1}, glm::vec3(50000));
    RenderSettings settings;
    settings.sun_shadows = SunShadows::volumes;
    scene.set_render_settings(settings);
    const Image image = render(scene, camera_above(50, 1.5f), 96);
    // Half a metre beside each.
    const auto at = [&](float x) {
        return image.at(static_cast<int>((x / 1.5f + 1) * 48), static_cast<int>((-0.5f / 1.5f + 1) * 48));
    };
    EXPECT_EQ(at(-0.9f), 0);
    EXPECT_GT(at(0), 0);
    EXPECT_EQ(at(0.9f), 0);
    EXPECT_GT(at(0.45f), 0);
}

TEST_F(ShadowVolumesTest, MapsOfTheirLightAreDrawnOnlyForThoseWhoAskThem) {
    Scene scene = boxes_and_spheres();
    scene.add_sensor({.name = "behind the first box", .position = {-0.5f, 0.02f, -0.35f}});
    scene.add_sensor({.name = "open", .position = {3, 0.02f, 3}});
    const Camera camera = camera_from({3, 2.2f, 4}, {0, 0.5f, 0});
    RealtimeOptions options;
    options.width = 32, options.height = 24, options.samples = 1;
    const auto picture = [&](std::uint64_t& maps, const char* gi = "none") {
        options.gi = gi;
        RealtimeStatistics statistics;
        const Image image = render(scene, camera, options, &statistics).image;
        maps = statistics.shadow_maps_drawn;
        return image;
    };
    std::uint64_t maps = 0;
    const Image first = picture(maps);
    EXPECT_EQ(maps, 0u);
    const auto readings = renderer->measure(scene, options);
    ASSERT_TRUE(readings) << readings.error().text();
    EXPECT_EQ((*readings)[0].value, 0) << "sensors ask maps";
    EXPECT_GT((*readings)[1].value, 1e4);
    EXPECT_EQ(picture(maps).pixels, first.pixels);
    EXPECT_EQ(maps, 0u);
    RenderSettings settings = scene.render_settings();
    settings.voxels = 32;
    scene.set_render_settings(settings);
    (void)picture(maps, "vct");
    EXPECT_GT(maps, 0u) << "voxels ask maps";
    Material glass = lambert(glm::vec3(0.8f));
    glass.alpha_mode = AlphaMode::blend;
    glass.opacity = 0.5f;
    add_shape_node(scene, Quad{{-3, 1, -3}, {0, 0, 0.6f}, {0.6f, 0, 0}}, scene.add_material(glass));
    (void)picture(maps);
    EXPECT_GT(maps, 0u) << "a blended surface casts no volume";
}

Camera first_camera(const Scene& scene) {
    Camera camera;
    scene.cameras().each([&, found = false](CameraId, const Camera& each) mutable {
        if (!found) camera = each;
        found = true;
    });
    return camera;
}

/// A shared scene by the sun alone: its own, or that of `direction`.
std::optional<Scene> judgeable(const char* name, std::optional<glm::vec3> direction = {}) {
    const auto path = shared_path(std::string("scenes/") + name);
    if (!path) return std::nullopt;
    Warnings warnings;
    auto scene = load_scene(*path, {}, warnings);
    if (!scene) {
        ADD_FAILURE() << scene.error().text();
        return std::nullopt;
    }
    convert::FlatScene flat;
    (void)flat.update(*scene);
    for (const shading::LightData& light : flat.lights())
        if (light.type == shading::light_type_directional) direction = light.axis;
    scene->set_sky({});
    add_sun(*scene, direction.value(), glm::vec3(50000));
    make_judgeable(*scene);
    return std::move(*scene);
}

TEST_F(ShadowVolumesTest, ACarInTheAfternoonSunCastsTheShadowsThatRaysFind) {
    auto scene = judgeable("car-day.heliodon.json");
    if (!scene) GTEST_SKIP() << "shared data missing";
    const Difference d = difference(*scene, first_camera(*scene), width, height);
    EXPECT_LE(d.share(), 1e-3);
    EXPECT_GT(d.shadowed, width * height / 30);
}

TEST_F(ShadowVolumesTest, ASunnyRoomHasTheShadowsThatRaysFind) {
    if (!full_size) GTEST_SKIP() << "at full size only";
    auto scene = judgeable("natus.heliodon.json", glm::normalize(glm::vec3(0.3f, -0.45f, -0.85f)));
    if (!scene) GTEST_SKIP() << "shared data missing";
    const Difference d = difference(*scene, first_camera(*scene), width, height);
    EXPECT_LE(d.share(), 1e-3);
    EXPECT_GT(d.shadowed, width * height / 20);
}

}  // namespace
}  // namespace heliodon::tests
