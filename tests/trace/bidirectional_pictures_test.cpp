// Bidirectional path tracing: its strategies one by one, exact answers, what its pictures do not depend on, and where it
// is better.
#include <fmt/format.h>

#include <algorithm>

#include "core/metrics.h"
#include "import/import.h"
#include "picture_means.h"
#include "shading/random.h"
#include "trace/bidirectional_loop.h"

namespace heliodon::tests {
namespace {

using namespace trace;

// -- each strategy by itself

/// A floor, a wall, a board and a glass ball that touch nowhere: connections between corners would never settle. No leaning
/// normals: a light subpath does not leave below them, and other strategies have that light.
Scene apart() {
    Scene scene;
    add_shape(scene, Quad{{-2.5f, 0, -1.5f}, {0, 0, 3.5f}, {5, 0, 0}}, lambert(.7f));
    add_shape(scene, Quad{{-2.5f, .5f, -2}, {5, 0, 0}, {0, 3, 0}}, lambert(.6f));
    Material board = rough_glass();
    board.transmission = .5f;
    board.roughness = .8f;
    board.two_sided = true;
    add_shape(scene, Quad{{-.8f, .6f, -.3f}, {.7f, 0, 0}, {0, .6f, .2f}}, board);
    add_shape(scene, Sphere{{.7f, .55f, .8f}, .4f}, rough_glass());
    add_light(scene, point_light(40, .6f), {.8f, 1.9f, -.3f});
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
    PathOptions reference = pictures_of(16, 64, Integrator::path), alone = pictures_of(16, 16, Integrator::path);
    const PartMeans all = means_of(scene, camera, reference);
    const auto any = bidirectional_any;
    expect_equal_means("camera subpaths that meet the light", all, strategy_means(scene, camera, alone, {0, any}, false), .05);
    expect_equal_means("next-event estimation", all, strategy_means(scene, camera, alone, {1, any}, false));
    expect_equal_means("one scattered light vertex", all, strategy_means(scene, camera, alone, {2, any}, false));
    expect_equal_means("light subpaths that reach the camera", all, strategy_means(scene, camera, alone, {any, 1}, false));
    reference.aovs = {"indirect"};
    const PartMeans indirect = means_of(scene, camera, reference);
    expect_equal_means("indirect light that reaches the camera", indirect, strategy_means(scene, camera, alone, {any, 1}, true), .05);
    expect_equal_means("two scattered light vertices", indirect, strategy_means(scene, camera, alone, {3, any}, true), .1);
    expect_equal_means("one camera vertex, connected", indirect, strategy_means(scene, camera, alone, {any, 2}, true), .1);
}

TEST(Bidirectional, LightLeavesLeaningNormalsByTheGeometricCosine) {
    // The wall is where the floor's normals lean to, so that light subpaths find all that the floor sends there.
    Scene scene;
    Geometry floor = triangle_mesh({{-2.5f, 0, -1.5f}, {-2.5f, 0, 2}, {2.5f, 0, 2}, {-2.5f, 0, -1.5f}, {2.5f, 0, 2}, {2.5f, 0, -1.5f}});
    floor.mesh.normals.assign(6, glm::normalize(glm::vec3(0, 1, -.7f)));
    add_mesh(scene, std::move(floor), lambert(.9f));
    add_shape(scene, Quad{{-2.5f, .5f, -2}, {5, 0, 0}, {0, 3, 0}}, lambert(.6f));
    add_light(scene, point_light(40), {0, 1.6f, .1f});
    const Camera camera = looking({0, 1.8f, 1.5f}, {0, 1.8f, 0}, 35);
    PathOptions options = pictures_of(16, 64, Integrator::path);
    options.aovs = {"indirect"};
    expect_equal_means("floor to wall", means_of(scene, camera, options),
                       strategy_means(scene, camera, pictures_of(16, 32, Integrator::path), {bidirectional_any, 1}, true));
}

// -- samplers

TEST(LightEmission, DirectionsFollowTheirDensity) {
    LightData light{};
    light.axis = glm::normalize(glm::vec3(1, -2, .5f));
    light.cos_inner = .9f;
    light.cos_outer = .5f;
    for (const std::uint32_t type : {light_type_point, light_type_spot, light_type_lambertian}) {
        light.type = type;
        constexpr int bins = 40, samples = 200000;
        std::array<int, bins> counts{};
        for (int i = 0; i < samples; ++i) {
            const glm::vec3 direction = light_sample_emission(light, random2(7, static_cast<std::uint32_t>(i), 0, type));
            const double cosine = glm::dot(light.axis, direction);
            ++counts[std::clamp(static_cast<int>((cosine + 1) / 2 * bins), 0, bins - 1)];
        }
        double statistic = 0;
        int freedom = -1;
        for (int bin = 0; bin < bins; ++bin) {
            double expected = 0;
            constexpr int steps = 200;
            const Frame frame = frame_from_normal(light.axis);
            for (int k = 0; k < steps; ++k) {
                const double cosine = (bin + (k + .5) / steps) * 2 / bins - 1;
                const glm::vec3 local(std::sqrt(1 - cosine * cosine), 0, cosine);
                expected += samples * 2 * pi * light_emission_pdf(light, to_world(frame, local)) * 2 / bins / steps;
            }
            if (expected < 5) {
                EXPECT_LE(counts[bin], 20) << "type " << type << ", bin " << bin;
                continue;
            }
            ++freedom;
            statistic += (counts[bin] - expected) * (counts[bin] - expected) / expected;
        }
        // Six standard deviations of χ² over its mean.
        EXPECT_LT(statistic, freedom + 6 * std::sqrt(2.0 * freedom)) << "type " << type;
    }
}

// -- exact answers

TEST(Bidirectional, AClosedSphereThatEmitsHasTheRadianceOfItsSeries) {
    Scene scene;
    // Faces inward: mirrored.
    Transform inside_out;
    inside_out.scale = {-1, 1, 1};
    add_shape(scene, Sphere{{0, 0, 0}, 1}, lambert(.5f, .5f, true), inside_out);
    const PartMeans means = means_of(scene, looking({0, 0, .5f}, {0, 0, 0}, 60), pictures_of(16, 16, Integrator::bidirectional), 8);
    for (int i = 0; i < part_count; ++i) EXPECT_NEAR(means.mean(i), 1, .01) << "L/(1 - rho) in part " << i;
    EXPECT_NEAR(means.whole(), 1, .003);
}

// -- what the pictures do not depend on

TEST(Bidirectional, ThePictureDependsOnNeitherThreadsNorInterruption) {
    const Scene scene = small_room();
    PathOptions options = pictures_of(40, 6, Integrator::bidirectional);
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
    PathOptions options = pictures_of(16, 8, Integrator::path, 1);
    const PartMeans direct = means_of(scene, into_box(), options);
    options = pictures_of(16, 8, Integrator::bidirectional);
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
    PathOptions options = pictures_of(8, 4, Integrator::bidirectional);
    options.target_error = .1;
    PathTracer tracer;
    const Scene scene = small_room();
    ASSERT_TRUE(tracer.update(scene));
    const auto picture = tracer.render(scene, into_box(), options);
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().text().find("target error"), std::string::npos);
}

// -- better

/// relMSE of the picture that some `rays` rays make: a clock's time, but the same in every run.
double error_of(const Scene& scene, const Camera& camera, PathOptions options, double rays, const Image& reference) {
    PathStatistics one;
    options.samples_per_pixel = 1;
    (void)render(scene, camera, options, &one);
    options.samples_per_pixel = std::max(1, static_cast<int>(rays / static_cast<double>(one.rays)));
    options.seed = 7;
    return compare(reference, render(scene, camera, options).image, camera.ev100())->relmse;
}

void expect_better(const std::string& name, const Scene& scene, const Camera& camera, double times) {
    PathOptions path = pictures_of(32, 1, Integrator::path), both = pictures_of(32, 192, Integrator::bidirectional);
    const Image reference = render(scene, camera, both).image;
    constexpr double rays = 32 * 32 * 400;
    const double error = error_of(scene, camera, path, rays, reference);
    const double bidirectional = error_of(scene, camera, both, rays, reference);
    ::testing::Test::RecordProperty(name + "_ratio", fmt::format("{:.1f}", error / bidirectional));
    EXPECT_GT(error, times * bidirectional) << name << ": " << error << " against " << bidirectional;
}

TEST(Bidirectional, HasAFractionOfTheErrorForALampInAShade) {
    Warnings warnings;
    const auto scene = load_scene(std::string(HELIODON_SOURCE_DIR) + "/tests/scenes/lamp-shade.heliodon.json", {}, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    Camera camera;
    scene->cameras().each([&](CameraId, const Camera& c) { camera = c; });
    expect_better("lamp_in_a_shade", *scene, camera, 8);
}

TEST(Bidirectional, HasAFractionOfTheErrorForCausticsOfAPointLight) {
    Scene scene;
    add_shape(scene, Quad{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}}, lambert(.7f));
    add_shape(scene, Quad{{-1, 0, -1}, {2, 0, 0}, {0, 2, 0}}, lambert(.7f));
    Material glass;
    glass.base_color = glm::vec3(1);
    glass.transmission = 1;
    glass.roughness = .25f;
    add_shape(scene, Sphere{{0, .6f, 0}, .4f}, glass);
    add_light(scene, point_light(40), {.6f, 1.8f, .8f});
    expect_better("caustics", scene, into_box(), 3);
}

}  // namespace
}  // namespace heliodon::tests
