// Selecting among many lights: the density is exact, nothing that shines is left out, and ten thousand lights are
// hardly harder than ten.
#include <fmt/format.h>

#include <cmath>
#include <random>
#include <vector>

#include "scene_building.h"
#include "trace/cpu_kernel.h"

namespace heliodon::tests {
namespace {

using namespace heliodon::trace;

/// Lights of every kind at chance places in a room of 4 × 3 × 4 m.
Scene lights_of_all_kinds() {
    Scene scene;
    add_shape(scene, Quad{{-2, 0, -2}, {0, 0, 4}, {4, 0, 0}}, lambert(.7f));
    add_shape(scene, Quad{{-2, 0, -2}, {4, 0, 0}, {0, 3, 0}}, lambert(.5f));
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto place = [&] { return glm::vec3(4 * unit(random) - 2, .5f + 2.4f * unit(random), 4 * unit(random) - 2); };
    const auto turn = [&] {
        return rotation_from_euler_deg(360.0f * glm::vec3(unit(random), unit(random), unit(random)));
    };
    const auto turned = [&] {
        Transform transform;
        transform.translation = place();
        transform.rotation = turn();
        return transform;
    };
    for (int i = 0; i < 8; ++i) {
        add_light(scene, point_light(20 * unit(random), i % 2 ? .05f : 0), place());
        Light spot = point_light(50 * unit(random));
        spot.type = LightType::spot;
        spot.inner_rad = .2f;
        spot.outer_rad = .2f + unit(random);
        add_light(scene, spot, place(), turn());
        const Material lamp = lambert(0, 100 * unit(random), i % 2);
        add_shape(scene, Quad{{0, 0, 0}, {.2f, 0, 0}, {.05f * static_cast<float>(i % 3), .1f, 0}}, lamp, turned());
        add_shape(scene, Disk{{0, 0, 0}, {0, 1, 0}, .1f}, lamp, turned());
        Transform uneven = turned();
        if (i % 2) uneven.scale = {1, .5f, 2};
        add_shape(scene, Sphere{{0, 0, 0}, .05f}, lamp, uneven);
        add_shape(scene, Box{{0, 0, 0}, {.1f, .1f, .1f}}, lamp, turned());
    }
    Light sun;
    sun.type = LightType::directional;
    sun.intensity = glm::vec3(30);
    sun.direction = glm::normalize(glm::vec3(.2f, -1, -.4f));
    add_light(scene, sun, {0, 0, 0});
    return scene;
}

/// The kernel over a scene's emitters, without rays.
struct Emitters {
    explicit Emitters(const Scene& scene) {
        flat.update(scene);
        geometries = build_geometry_table(flat);
        table = build_emitters(flat, textures, true);
        kernel.frame.emitter_count = static_cast<uint>(table.emitters.size());
        kernel.frame.distant_emitters = table.distant_emitters;
        kernel.frame.light_node_count = static_cast<uint>(table.light_nodes.size());
        kernel.frame.sky_emitter = table.sky_emitter;
    }
    convert::FlatScene flat;
    TextureTable textures;
    GeometryTable geometries;
    EmitterTable table;
    CpuKernel kernel{flat, geometries, textures, table, {}};
};

/// Chance places in the room, with a normal or, every third time, without one.
template <class Visit>
void each_place(int count, Visit&& visit) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < count; ++i) {
        const vec3 from(4 * unit(random) - 2, 3 * unit(random), 4 * unit(random) - 2);
        const vec3 normal = sample_uniform_sphere(vec2(unit(random), unit(random)));
        visit(from, i % 3 == 2 ? vec3(0) : normal, random);
    }
}

TEST(LightTree, SelectsEachLightAsOftenAsItSaysItDoes) {
    const Scene scene = lights_of_all_kinds();
    Emitters lights(scene);
    ASSERT_GT(lights.table.light_nodes.size(), 100u);
    each_place(20, [&](vec3 from, vec3 normal, std::mt19937&) {
        std::vector<double> expected;
        double sum = 0;
        for (const KernelEmitter& emitter : lights.table.emitters) {
            expected.push_back(
                emitter.probability > 0 ? lights.kernel.kernel_selection_probability(emitter, from, normal) : 0);
            sum += expected.back();
        }
        EXPECT_LT(sum, 1 + 1e-5) << "the rest of the walks end where bounds said more than was there";
        // An even comb of u: each count is off by the rounding of its two ends at most, and of the walk's divisions.
        constexpr int comb = 1 << 16;
        std::vector<int> count(expected.size() + 1);
        expected.push_back(1 - sum);
        for (int i = 0; i < comb; ++i) {
            float probability = 0;
            const uint selected = lights.kernel.kernel_select_emitter_at(from, normal, (i + .5f) / comb, probability);
            ++count[std::min<std::size_t>(selected, expected.size() - 1)];
            if (selected != kernel_no_emitter) ASSERT_NEAR(probability, expected[selected], 1e-4 * expected[selected]);
        }
        for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(count[i], comb * expected[i], 4) << i;
    });
}

TEST(LightTree, LeavesOutNothingThatShines) {
    const Scene scene = lights_of_all_kinds();
    Emitters lights(scene);
    int shining = 0;
    each_place(2000, [&](vec3 from, vec3 normal, std::mt19937& random) {
        std::uniform_real_distribution<float> unit(0, 1);
        for (const KernelEmitter& emitter : lights.table.emitters) {
            const vec2 u(unit(random), unit(random));
            const KernelLightSample light =
                emitter.kind == kernel_emitter_light
                    ? lights.kernel.kernel_sample_light(lights.kernel.fetch_light(emitter.index), from, u)
                    : lights.kernel.kernel_sample_surface(emitter, from, u);
            if (!(max_component(light.light) > 0) ||
                (normal != vec3(0) && !(glm::dot(normal, light.direction) > 1e-4f)))
                continue;
            ++shining;
            EXPECT_GT(lights.kernel.kernel_selection_probability(emitter, from, normal), 0) << emitter.kind;
        }
    });
    EXPECT_GT(shining, 50000);
}

PathOptions options_of(int samples, std::uint32_t seed, int max_depth) {
    PathOptions options;
    options.width = 24;
    options.height = 16;
    options.samples_per_pixel = samples;
    options.max_depth = max_depth;
    options.seed = seed;
    return options;
}

TEST(LightTree, GivesTheSameMeanAsSelectionByFlux) {
    // Squares of 4 × 4 pixels over independent pictures of either kind.
    const Scene scene = lights_of_all_kinds();
    const Camera camera = looking({0, 1.5f, 5}, {0, 1, 0}, 45);
    constexpr int pictures = 16, squares = 6 * 4;
    std::vector<double> sum[2], squared[2];
    for (const int tree : {0, 1}) {
        sum[tree].resize(squares);
        squared[tree].resize(squares);
        for (int i = 0; i < pictures; ++i) {
            PathOptions options = options_of(32, 2 * i + tree, 2);
            options.light_tree = tree;
            const Picture picture = render(scene, camera, options);
            std::vector<double> values(squares);
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 24; ++x) values[y / 4 * 6 + x / 4] += luminance(picture.image.rgb(x, y)) / 16;
            for (int s = 0; s < squares; ++s) {
                sum[tree][s] += values[s] / pictures;
                squared[tree][s] += values[s] * values[s] / pictures;
            }
        }
    }
    double worst = 0;
    for (int s = 0; s < squares; ++s) {
        double variance[2];
        for (const int tree : {0, 1})
            variance[tree] = (squared[tree][s] - sum[tree][s] * sum[tree][s]) / (pictures - 1);
        const double z = (sum[1][s] - sum[0][s]) / std::sqrt(variance[0] + variance[1] + 1e-12);
        worst = std::max(worst, std::abs(z));
    }
    RecordProperty("worst_z", std::to_string(worst));
    // Student's t of some 20 degrees of freedom passes 4.3 in 24 trials once in a hundred times.
    EXPECT_LT(worst, 4.3);
}

/// `count` equal lamps of 10 000 lm together, evenly over the ceiling of a room of 8 × 3 × 8 m with pillars in it.
Scene lamps(int count) {
    Scene scene;
    const Material white = lambert(.7f);
    add_shape(scene, Quad{{-4, 0, -4}, {0, 0, 8}, {8, 0, 0}}, white);
    add_shape(scene, Quad{{-4, 0, -4}, {8, 0, 0}, {0, 3, 0}}, white);
    add_shape(scene, Quad{{-4, 0, 4}, {0, 0, -8}, {0, 3, 0}}, lambert(.4f));
    add_shape(scene, Quad{{4, 0, -4}, {0, 0, 8}, {0, 3, 0}}, lambert(.4f));
    for (const float x : {-2.0f, 0.0f, 2.0f})
        for (const float z : {-2.0f, 1.0f}) add_shape(scene, Box{{x - .2f, 0, z - .2f}, {x + .2f, 2, z + .2f}}, white);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-3.9f, 3.9f);
    for (int i = 0; i < count; ++i)
        add_light(scene, point_light(static_cast<float>(10000 / (4 * pi) / count)), {unit(random), 2.8f, unit(random)});
    return scene;
}

/// Mean of d²/(r² + 0.01) at an exposure that shows 100 cd/m² as white: by flux, and by the tree.
glm::dvec2 relmse(const Scene& scene, int max_depth) {
    const Camera camera = looking({0, 1.6f, 7.5f}, {0, 1.2f, 0}, 45);
    const Picture reference = render(scene, camera, options_of(2048, 99, max_depth));
    constexpr int pictures = 8;
    glm::dvec2 sum(0);
    for (int i = 0; i < 2 * pictures; ++i) {
        PathOptions options = options_of(16, i, max_depth);
        options.light_tree = i % 2;
        const Picture picture = render(scene, camera, options);
        for (std::size_t k = 0; k < picture.image.pixels.size(); ++k) {
            const double r = reference.image.pixels[k] / 100, d = picture.image.pixels[k] / 100 - r;
            sum[i % 2] += d * d / (r * r + 0.01) / (pictures * static_cast<double>(picture.image.pixels.size()));
        }
    }
    return sum;
}

TEST(LightTree, TenThousandLightsHaveAtMostTwiceTheErrorOfTenAtEqualSamples) {
    for (const int max_depth : {1, 3}) {
        const glm::dvec2 ten = relmse(lamps(10), max_depth), many = relmse(lamps(10000), max_depth);
        RecordProperty(fmt::format("relmse_of_10_depth_{}", max_depth), fmt::format("{:.5f} {:.5f}", ten[0], ten[1]));
        RecordProperty(fmt::format("relmse_of_10000_depth_{}", max_depth),
                       fmt::format("{:.5f} {:.5f}", many[0], many[1]));
        EXPECT_LE(many[1], 2 * ten[1]) << max_depth;
        EXPECT_LT(many[1], 0.7 * many[0]) << "against selection by flux, " << max_depth;
    }
}

}  // namespace
}  // namespace heliodon::tests
