// Bidirectional path tracing: equal in the mean to the path tracer whatever emits, scatters and hides, and better
// where paths from the camera hardly find the light.
#include "trace/bidirectional_loop.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include "core/metrics.h"
#include "scene/luminaire.h"
#include "scene_building.h"

namespace heliodon::tests {
namespace {

using namespace trace;

PathOptions options_of(int size, int samples, Integrator integrator, int max_depth = 0) {
    PathOptions options;
    options.width = options.height = size;
    options.samples_per_pixel = samples;
    options.max_depth = max_depth;
    options.integrator = integrator;
    return options;
}

// -- statistics: the picture in square parts, each part's mean luminance over many independent renders

constexpr int parts_across = 4, part_count = parts_across * parts_across;

struct PartMeans {
    std::array<double, part_count> sum{}, squares{};
    int renders = 0;

    void add(const Image& image) {
        std::array<double, part_count> means{};
        const int edge = image.width / parts_across;
        for (int y = 0; y < edge * parts_across; ++y)
            for (int x = 0; x < edge * parts_across; ++x)
                means[y / edge * parts_across + x / edge] += luminance(image.rgb(x, y)) / (edge * edge);
        for (int i = 0; i < part_count; ++i) {
            sum[i] += means[i];
            squares[i] += means[i] * means[i];
        }
        ++renders;
    }
    [[nodiscard]] double mean(int part) const { return sum[part] / renders; }
    /// Of the mean.
    [[nodiscard]] double variance(int part) const {
        return std::max(0.0, squares[part] / renders - mean(part) * mean(part)) / (renders - 1);
    }
    [[nodiscard]] double whole() const {
        double total = 0;
        for (int i = 0; i < part_count; ++i) total += mean(i) / part_count;
        return total;
    }
};

/// Welch's test of each part. 5.5 standard errors are exceeded by chance once in 10⁶ parts with some 60 degrees of
/// freedom (Student's t): these tests look at a thousand. A part must also be known well enough to be worth testing.
void expect_equal_means(const std::string& name, const PartMeans& a, const PartMeans& b, double precision = 0.03) {
    ASSERT_GT(a.whole(), 0) << name;
    double of_picture = 0;
    for (int i = 0; i < part_count; ++i) {
        const double error = std::sqrt(a.variance(i) + b.variance(i));
        of_picture += error * error / (part_count * part_count);
        EXPECT_NEAR(a.mean(i), b.mean(i), 5.5 * error + 1e-5 * a.whole()) << name << ", part " << i;
    }
    EXPECT_LT(std::sqrt(of_picture), precision * a.whole()) << name << ": too noisy to say anything";
}

PartMeans means_of(const Scene& scene, const Camera& camera, PathOptions options, int renders = 32) {
    PathTracer tracer;
    EXPECT_TRUE(tracer.update(scene));
    PartMeans means;
    for (int i = 0; i < renders; ++i) {
        options.seed = static_cast<std::uint32_t>(i);
        auto picture = tracer.render(scene, camera, options);
        EXPECT_TRUE(picture) << (picture ? "" : picture.error().text());
        if (picture) means.add(options.aovs.empty() ? picture->image : picture->layers[0].image);
    }
    return means;
}

void expect_both_modes_agree(const std::string& name, const Scene& scene, const Camera& camera, int max_depth = 0,
                             int samples = 4, double precision = 0.03) {
    expect_equal_means(name, means_of(scene, camera, options_of(16, 2 * samples, Integrator::path, max_depth)),
                       means_of(scene, camera, options_of(16, samples, Integrator::bidirectional, max_depth)), precision);
}

// -- scenes

Camera into_box() {
    return looking({0, 1, 3.4f}, {0, 1, 0});
}

Material rough_glass() {
    Material glass;
    glass.base_color = {.9f, .95f, 1};
    glass.transmission = 1;
    glass.roughness = .6f;
    return glass;
}

/// A box open to the camera, with a rough metal ball, a coated block and a glass ball where asked.
Scene box_scene(bool glass = true) {
    Scene scene;
    const Material white = lambert(.7f);
    Material red = white, metal, coated;
    red.base_color = {.6f, .1f, .05f};
    metal.base_color = {.9f, .6f, .3f};
    metal.metallic = 1;
    metal.roughness = .6f;
    coated.base_color = {.2f, .5f, .3f};
    coated.clearcoat = 1;
    coated.clearcoat_roughness = .6f;
    add_shape(scene, Quad{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}}, white);
    add_shape(scene, Quad{{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}}, white);
    add_shape(scene, Quad{{-1, 0, -1}, {2, 0, 0}, {0, 2, 0}}, white);
    add_shape(scene, Quad{{-1, 0, -1}, {0, 2, 0}, {0, 0, 2}}, red);
    add_shape(scene, Sphere{{-.5f, .35f, -.2f}, .35f}, metal);
    add_shape(scene, Box{{-.3f, 0, .3f}, {0, .3f, .6f}}, coated);
    if (glass) add_shape(scene, Sphere{{.4f, .45f, .2f}, .4f}, rough_glass());
    return scene;
}

Light spot_light(float radius_m) {
    Light light = point_light(60, radius_m);
    light.type = LightType::spot;
    light.inner_rad = .3f;
    light.outer_rad = 1;
    return light;
}

Light beam(float angular_diameter_rad) {
    Light light;
    light.type = LightType::directional;
    light.intensity = {500, 450, 400};
    light.angular_diameter_rad = angular_diameter_rad;
    return light;
}

Light luminaire(glm::vec3 opening_m) {
    auto measured = std::make_shared<Luminaire>();
    measured->web.polar_rad = {0, pi / 6, pi / 3, pi / 2};
    measured->web.azimuth_rad = {0};
    measured->web.candela = {60, 90, 30, 0};
    measured->opening = {opening_m.x > 0 ? OpeningShape::box : OpeningShape::point, opening_m};
    integrate(*measured);
    Light light;
    light.type = LightType::luminaire;
    light.intensity = glm::vec3(static_cast<float>(measured->peak_cd));
    light.luminaire = measured;
    return light;
}

/// A dim sky of 8 × 4 texels with a bright one, up in front of the camera.
void add_image_sky(Scene& scene) {
    constexpr int columns = 8, rows = 4;
    std::vector<float> texels(4 * columns * rows, 1.0f);
    for (int c = 0; c < 3; ++c) texels[4 * (1 * columns + 1) + c] = 60;
    Texture image;
    image.width = columns;
    image.height = rows;
    image.format = TextureFormat::float32;
    image.levels.emplace_back(texels.size() * sizeof(float));
    std::memcpy(image.levels[0].data(), texels.data(), image.levels[0].size());
    Sky sky;
    sky.model = SkyModel::image;
    sky.luminance_nits = glm::vec3(10);
    sky.image = scene.add_texture(std::move(image));
    scene.set_sky(sky);
}

TEST(Bidirectional, AgreesWithThePathTracerWhateverEmits) {
    const Material lamp = lambert(.2f, 300), both_sides = lambert(.2f, 150, true);
    const glm::quat down = aiming_down();
    const std::vector<std::pair<std::string, std::function<void(Scene&)>>> emitters{
        {"point", [](Scene& s) { add_light(s, point_light(40), {.2f, 1.6f, .1f}); }},
        {"sphere light", [](Scene& s) { add_light(s, point_light(40, .2f), {.2f, 1.6f, .1f}); }},
        {"spot", [&](Scene& s) { add_light(s, spot_light(0), {.2f, 1.8f, .1f}, down); }},
        {"spot of a sphere", [&](Scene& s) { add_light(s, spot_light(.1f), {.2f, 1.8f, .1f}, down); }},
        {"lambertian",
         [&](Scene& s) {
             Light light = point_light(60);
             light.lambertian = true;
             add_light(s, light, {.2f, 1.8f, .1f}, down);
         }},
        {"directional", [](Scene& s) { add_light(s, beam(0), {}, glm::angleAxis(-.6f, glm::vec3(1, .5f, 0))); }},
        {"directional disc", [](Scene& s) { add_light(s, beam(.2f), {}, glm::angleAxis(-.6f, glm::vec3(1, .5f, 0))); }},
        {"quad", [&](Scene& s) { add_shape(s, Quad{{-.3f, 1.9f, -.3f}, {.6f, 0, 0}, {0, 0, .6f}}, lamp); }},
        {"parallelogram", [&](Scene& s) { add_shape(s, Quad{{-.3f, 1.9f, -.3f}, {.6f, 0, .3f}, {0, 0, .6f}}, both_sides); }},
        {"disk", [&](Scene& s) { add_shape(s, Disk{{0, 1.9f, 0}, {0, -1, 0}, .3f}, lamp); }},
        {"sphere", [&](Scene& s) { add_shape(s, Sphere{{.1f, 1.6f, 0}, .15f}, lamp); }},
        {"ellipsoid", [&](Scene& s) { add_shape(s, Sphere{{0, 1.6f, 0}, .2f}, lamp, {.scale = {1, .5f, 1.6f}}); }},
        {"box of triangles", [&](Scene& s) { add_shape(s, Box{{-.2f, 1.4f, -.1f}, {.2f, 1.6f, .1f}}, lamp); }},
        {"luminaire", [](Scene& s) { add_light(s, luminaire({0, 0, 0}), {.2f, 1.8f, .1f}); }},
        {"luminaire with an opening", [](Scene& s) { add_light(s, luminaire({.5f, .1f, .3f}), {.2f, 1.8f, .1f}); }},
        {"constant sky", [](Scene& s) { s.set_sky(even_sky(30)); }},
        {"image sky", add_image_sky},
        {"constant sky and lamp",
         [&](Scene& s) {
             s.set_sky(even_sky(10));
             add_shape(s, Disk{{0, 1.9f, 0}, {0, -1, 0}, .3f}, lamp);
         }},
    };
    for (const auto& [name, add] : emitters) {
        Scene scene = box_scene();
        add(scene);
        expect_both_modes_agree(name, scene, into_box());
    }
}

TEST(Bidirectional, AgreesAtEveryDepth) {
    Scene scene = box_scene();
    add_light(scene, point_light(40, .1f), {.2f, 1.6f, .1f});
    add_shape(scene, Disk{{-.5f, 1.9f, 0}, {0, -1, 0}, .2f}, lambert(.2f, 300));
    scene.set_sky(even_sky(3));
    for (const int depth : {1, 2, 3, 4}) expect_both_modes_agree(fmt::format("depth {}", depth), scene, into_box(), depth);
}

/// Normals that lean away from their triangles by up to 40°, and a map that leans them further.
Scene bent_normals() {
    Scene scene = box_scene(false);
    add_light(scene, point_light(40), {.2f, 1.6f, .1f});
    Geometry sheet = triangle_mesh({{-.6f, .3f, .3f}, {.6f, .3f, .3f}, {.6f, 1.1f, -.3f}, {-.6f, .3f, .3f}, {.6f, 1.1f, -.3f}, {-.6f, 1.1f, -.3f}});
    for (const glm::vec3& position : sheet.mesh.positions) {
        sheet.mesh.normals.push_back(glm::normalize(glm::vec3(1.2f * position.x, 1, 1.4f)));
        sheet.mesh.texcoords[0].push_back(3.0f * glm::vec2(position));
        sheet.mesh.tangents.push_back({1, 0, 0, 1});
    }
    Texture map;
    map.width = map.height = 4;
    map.format = TextureFormat::float32;
    std::vector<float> texels;
    for (int i = 0; i < 16; ++i) texels.insert(texels.end(), {.5f + .25f * (i % 3 - 1), .5f + .2f * (i / 4 % 3 - 1), 1, 1});
    map.levels.emplace_back(texels.size() * sizeof(float));
    std::memcpy(map.levels[0].data(), texels.data(), map.levels[0].size());
    Material glossy = rough_glass();
    glossy.transmission = .4f;
    glossy.two_sided = true;
    glossy.normal_texture.texture = scene.add_texture(std::move(map));
    add_mesh(scene, std::move(sheet), glossy);
    return scene;
}

TEST(Bidirectional, AgreesWhereShadingNormalsLeaveTheGeometry) {
    expect_both_modes_agree("bent normals", bent_normals(), into_box());
}

TEST(Bidirectional, AgreesThroughVeilsMasksAndGlass) {
    Scene scene = small_room();
    expect_both_modes_agree("small room", scene, into_box(), 0, 8, .05);
}

// -- each strategy by itself

/// A floor, a wall and a board that touch nowhere: connections between corners would never settle.
Scene apart() {
    Scene scene;
    add_shape(scene, Quad{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}}, lambert(.7f));
    add_shape(scene, Quad{{-1, .5f, -2}, {2, 0, 0}, {0, 2, 0}}, lambert(.6f));
    Material board = rough_glass();
    board.transmission = .5f;
    board.roughness = .8f;
    board.two_sided = true;
    add_shape(scene, Quad{{-.8f, .6f, -.3f}, {.7f, 0, 0}, {0, .6f, .2f}}, board);
    add_light(scene, point_light(40, .3f), {.8f, 1.6f, .1f});
    return scene;
}

KernelFrame frame_of(const Camera& camera, const PathOptions& options, const EmitterTable& emitters) {
    const float tangent = std::tan(0.5f * camera.vertical_fov_rad);
    KernelFrame frame{};
    frame.camera_position = camera.position;
    frame.camera_forward = {0, 0, -1};
    frame.camera_right = {tangent, 0, 0};
    frame.camera_up = {0, tangent, 0};
    frame.width = static_cast<std::uint32_t>(options.width);
    frame.height = static_cast<std::uint32_t>(options.height);
    frame.seed = options.seed;
    frame.emitter_count = static_cast<std::uint32_t>(emitters.emitters.size());
    frame.visible_light_count = static_cast<std::uint32_t>(emitters.visible_lights.size());
    frame.environment = frame.scattered_emission = frame.sample_streams = 1;
    frame.sky_emitter = emitters.sky_emitter;
    return frame;
}

/// The light that the only strategy with so many vertices on either side finds, unweighted.
PartMeans strategy_means(const Scene& scene, const Camera& camera, const PathOptions& chosen, glm::uvec2 only, bool indirect) {
    convert::FlatScene flat;
    EmbreeScene embree;
    EXPECT_TRUE(embree.update(flat, flat.update(scene)));
    const TextureTable textures;
    const GeometryTable geometries = build_geometry_table(flat);
    const EmitterTable emitters = build_emitters(flat, textures, true);
    const EmissionTable emission = build_emission(flat, emitters, true);
    PartMeans means;
    for (int i = 0; i < 32; ++i) {
        PathOptions options = chosen;
        options.seed = static_cast<std::uint32_t>(i);
        if (indirect) options.aovs = {"indirect"};
        CpuKernel kernel{flat, geometries, textures, emitters, frame_of(camera, options, emitters)};
        BidirectionalKernel bidirectional(kernel, emission);
        bidirectional.only_strategy = only;
        PathStatistics statistics;
        const auto picture = render_picture(kernel, embree, options, 0, statistics, {},
                                                   bidirectional_samples(bidirectional, embree));
        EXPECT_TRUE(picture);
        means.add(indirect ? picture->layers[0].image : picture->image);
    }
    return means;
}

TEST(Bidirectional, EveryStrategyAloneFindsTheSameLight) {
    const Scene scene = apart();
    const Camera camera = looking({0, 1, 3.4f}, {0, 1, 0});
    PathOptions reference = options_of(16, 64, Integrator::path), alone = options_of(16, 16, Integrator::path);
    const PartMeans all = means_of(scene, camera, reference);
    const auto any = bidirectional_any;
    expect_equal_means("camera subpaths that meet the light", all, strategy_means(scene, camera, alone, {0, any}, false));
    expect_equal_means("next-event estimation", all, strategy_means(scene, camera, alone, {1, any}, false));
    expect_equal_means("one scattered light vertex", all, strategy_means(scene, camera, alone, {2, any}, false));
    expect_equal_means("light subpaths that reach the camera", all, strategy_means(scene, camera, alone, {any, 1}, false));
    reference.aovs = {"indirect"};
    const PartMeans indirect = means_of(scene, camera, reference);
    expect_equal_means("two scattered light vertices", indirect, strategy_means(scene, camera, alone, {3, any}, true));
    expect_equal_means("one camera vertex, connected", indirect, strategy_means(scene, camera, alone, {any, 2}, true), .1);
}

// -- exact answers

TEST(Bidirectional, AClosedSphereThatEmitsHasTheRadianceOfItsSeries) {
    Scene scene;
    // Faces inward: mirrored.
    Transform inside_out;
    inside_out.scale = {-1, 1, 1};
    add_shape(scene, Sphere{{0, 0, 0}, 1}, lambert(.5f, .5f, true), inside_out);
    const PartMeans means = means_of(scene, looking({0, 0, .5f}, {0, 0, 0}, 60), options_of(16, 16, Integrator::bidirectional), 8);
    for (int i = 0; i < part_count; ++i) EXPECT_NEAR(means.mean(i), 1, .01) << "L/(1 - rho) in part " << i;
    EXPECT_NEAR(means.whole(), 1, .003);
}

// -- what the pictures do not depend on

TEST(Bidirectional, ThePictureDependsOnNeitherThreadsNorInterruption) {
    const Scene scene = small_room();
    PathOptions options = options_of(40, 6, Integrator::bidirectional);
    options.threads = 1;
    const Picture one = render(scene, into_box(), options);
    for (const int threads : {2, 8}) {
        options.threads = threads;
        EXPECT_EQ(render(scene, into_box(), options).image.pixels, one.image.pixels) << threads << " threads";
    }
    options.threads = 0;
    options.keep_state = KeepState::always;
    options.samples_per_pixel = 2;
    const Picture begun = render(scene, into_box(), options);
    options.samples_per_pixel = 6;
    options.resume = &begun;
    EXPECT_EQ(render(scene, into_box(), options).image.pixels, one.image.pixels) << "resumed";
}

TEST(Bidirectional, DirectAndIndirectLightAddUpAndAgreeWithThePathTracers) {
    Scene scene = box_scene();
    add_light(scene, point_light(40, .1f), {.2f, 1.6f, .1f});
    PathOptions options = options_of(16, 8, Integrator::path, 1);
    const PartMeans direct = means_of(scene, into_box(), options);
    options = options_of(16, 8, Integrator::bidirectional);
    options.aovs = {"direct", "indirect", "variance"};
    const Picture picture = render(scene, into_box(), options);
    ASSERT_EQ(picture.layers.size(), 3u);
    for (std::size_t i = 0; i < picture.image.pixels.size(); ++i)
        EXPECT_NEAR(picture.layers[0].image.pixels[i] + picture.layers[1].image.pixels[i], picture.image.pixels[i],
                    1e-5f * (1 + picture.image.pixels[i]));
    options.aovs = {"direct"};
    expect_equal_means("direct", direct, means_of(scene, into_box(), options));
}

TEST(Bidirectional, ATargetErrorIsRefused) {
    PathOptions options = options_of(8, 4, Integrator::bidirectional);
    options.target_error = .1;
    PathTracer tracer;
    const Scene scene = small_room();
    ASSERT_TRUE(tracer.update(scene));
    const auto picture = tracer.render(scene, into_box(), options);
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().text().find("target error"), std::string::npos);
}

}  // namespace
}  // namespace heliodon::tests
