// Luminaires: what their table says is what they send, from a point and from every kind of opening.
#include "shading/luminaire_shape.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace heliodon::shading {
namespace {

/// Answers the table that luminaire.h reads.
struct Photometry {
    std::vector<float> table;
    float luminaire_value(uint i) const { return table[i]; }

#include "shading/luminaire.h"
};

/// A downlight with a little light upwards, brighter to C0.
Photometry photometry() {
    constexpr int polar_count = 13, azimuth_count = 9;
    Photometry result;
    result.table = {polar_count, azimuth_count};
    for (int i = 0; i < polar_count; ++i) result.table.push_back(static_cast<float>(i) * pi / (polar_count - 1));
    for (int i = 0; i < azimuth_count; ++i)
        result.table.push_back(static_cast<float>(i) * 2 * pi / (azimuth_count - 1));
    for (int a = 0; a < azimuth_count; ++a)
        for (int p = 0; p < polar_count; ++p) {
            const float down = std::cos(static_cast<float>(p) * pi / (polar_count - 1));
            const float along = std::cos(static_cast<float>(a) * 2 * pi / (azimuth_count - 1));
            result.table.push_back((down > 0 ? 0.2f + 0.8f * down * down : 0.1f) * (0.75f + 0.25f * along));
        }
    return result;
}

struct Opening {
    const char* name;
    uint shape;
    vec3 half_extent;
};
const std::array openings{
    Opening{"box", opening_box, {0.3f, 0.1f, 0.2f}},         Opening{"rectangle", opening_box, {0.3f, 0.1f, 0}},
    Opening{"wall", opening_box, {0, 0.4f, 0.1f}},           Opening{"disc", opening_cylinder_z, {0.3f, 0.3f, 0}},
    Opening{"drum", opening_cylinder_z, {0.3f, 0.2f, 0.1f}}, Opening{"tube", opening_cylinder_x, {0.5f, 0.1f, 0.15f}},
    Opening{"pipe", opening_cylinder_y, {0.1f, 0.5f, 0.1f}}, Opening{"sphere", opening_ellipsoid, {0.2f, 0.2f, 0.2f}},
    Opening{"egg", opening_ellipsoid, {0.1f, 0.3f, 0.2f}}};

LightData luminaire(const Opening& opening) {
    LightData light{};
    light.type = light_type_luminaire;
    light.position = vec3(1, 2, 3);
    light.axis = normalize(vec3(0.1f, -1, 0.2f));
    light.tangent = normalize(cross(light.axis, vec3(0, 0.1f, 1)));
    light.intensity = vec3(100, 50, 25);
    light.half_extent = opening.half_extent;
    light.opening = opening.shape;
    light.radius = length(opening.half_extent);
    return light;
}

/// Every face now and then, some more often.
uint face_weights(const Opening& opening) {
    const vec3 h = opening.half_extent;
    if (opening.shape == opening_box && h.z == 0) return 3u << 20 | 5u << 25;
    if (opening.shape == opening_box && h.x == 0) return 3u | 5u << 5;
    if (opening.shape == opening_box) return 9u | 4u << 5 | 7u << 10 | 2u << 15 | 31u << 20 | 5u << 25;
    return (h.z > 0 ? 6u : 0u) | 20u << 20 | 5u << 25;
}

struct Random {
    std::mt19937 bits{5};
    float number() { return std::uniform_real_distribution<float>(0, 1)(bits); }
    vec2 pair() { return vec2(number(), number()); }
    vec3 direction() { return sample_uniform_sphere(pair()); }
};

class Openings : public testing::TestWithParam<std::size_t> {
protected:
    Photometry photometry_ = photometry();
    Opening opening_ = openings[GetParam()];
    LightData light_ = luminaire(opening_);
    Random random_;
};

/// Places outside: near each face, in line with it, and far.
std::vector<vec3> receivers(const Opening& opening) {
    const vec3 h = opening.half_extent;
    return {vec3(0.05f, 0.02f, h.z + 0.05f), vec3(h.x + 0.02f, 0.01f, -0.03f),
            vec3(-h.x - 0.3f, h.y + 0.2f, h.z + 0.4f), vec3(0.03f, -h.y - 0.1f, h.z + 0.01f), vec3(2, -1, -3)};
}

// The solid angle of the opening in cells of directions: from the density of what is sampled, against directions picked
// evenly that meet it.
TEST_P(Openings, AreSampledWithTheDensityThatTheySay) {
    constexpr int samples = 60000, cells_a_side = 4, cells = cells_a_side * cells_a_side;
    for (const vec3 from : receivers(opening_)) {
        const vec3 center = normalize(-from);
        const float cap = std::min(
            2.0f,
            2.2f * (1 - std::sqrt(1 - std::min(1.0f, dot(light_.half_extent, light_.half_extent) / dot(from, from)))));
        const Frame frame = frame_from_normal(center);
        const auto cell_of = [&](vec3 direction) {
            const vec3 local = to_local(frame, direction);
            const int ring = std::clamp(static_cast<int>((1 - local.z) / cap * cells_a_side), 0, cells_a_side - 1);
            const int sector = static_cast<int>((std::atan2(local.y, local.x) / (2 * pi) + 0.5f) * cells_a_side);
            return ring * cells_a_side + std::min(sector, cells_a_side - 1);
        };
        const double one = 2 * pi * cap / samples;  // sr a direction; a cell that none met may be worth one
        std::array<double, cells> covered{}, sampled_covered{}, variance{};
        for (int i = 0; i < samples; ++i) {
            const OpeningSample sampled = opening_sample(opening_.shape, opening_.half_extent, from, random_.pair());
            ASSERT_GT(sampled.pdf, 0.0f) << opening_.name;
            const auto picked = static_cast<std::size_t>(cell_of(sampled.direction));
            sampled_covered[picked] += 1 / (double(sampled.pdf) * samples);
            variance[picked] += 1 / (double(sampled.pdf) * samples * sampled.pdf * samples);
            const OpeningHit hit = opening_intersect(opening_.shape, opening_.half_extent, from, sampled.direction);
            // At its edge, where the side of a cylinder is seen end on, one rounding error is a large share.
            if (hit.t > 0 && std::abs(dot(hit.normal, sampled.direction)) > 0.05f) {
                EXPECT_NEAR(hit.t, sampled.t, 2e-3f * sampled.t) << opening_.name;
                EXPECT_NEAR(
                    opening_pdf(opening_.shape, opening_.half_extent, from, sampled.direction, hit) / sampled.pdf, 1,
                    0.02)
                    << opening_.name;
            }
            const vec3 direction = to_world(frame, sample_cone(random_.pair(), cap));
            if (opening_intersect(opening_.shape, opening_.half_extent, from, direction).t <= 0) continue;
            covered[static_cast<std::size_t>(cell_of(direction))] += one;
            variance[static_cast<std::size_t>(cell_of(direction))] += one * one;
        }
        double worst = 0;
        for (std::size_t cell = 0; cell < cells; ++cell)
            worst = std::max(worst,
                             std::abs(sampled_covered[cell] - covered[cell]) / std::sqrt(variance[cell] + one * one));
        EXPECT_LT(worst, 4.5) << opening_.name << " from " << from.x << ' ' << from.y << ' ' << from.z;
    }
}

TEST_P(Openings, HaveTheOutlineThatTheirSurfaceHas) {
    constexpr int samples = 200000;
    const vec3 direction = normalize(vec3(0.4f, -0.3f, 0.6f));
    const float area = opening_projected_area(opening_.shape, opening_.half_extent, direction);
    const uint weights = face_weights(opening_);
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        const OpeningPoint point = opening_surface_point(opening_.shape, opening_.half_extent, weights, random_.pair());
        sum += std::max(dot(point.weighted_normal, direction), 0.0f);
        for (int k = 0; k < 3; ++k) EXPECT_LE(std::abs(point.position[k]), opening_.half_extent[k] * 1.0001f);
    }
    if (!opening_is_flat(opening_.half_extent)) {
        EXPECT_NEAR(sum / samples / area, 1, 0.01) << opening_.name;
    }
    // And rays that meet it cover as much.
    const Frame frame = frame_from_normal(direction);
    const float side = 1.2f;
    int met = 0;
    for (int i = 0; i < samples; ++i) {
        const vec3 from = direction * 3.0f + frame.tangent * (side * (random_.number() - 0.5f)) +
                          frame.bitangent * (side * (random_.number() - 0.5f));
        met += opening_intersect(opening_.shape, opening_.half_extent, from, -direction).t > 0;
    }
    const double share = area / (side * side);
    EXPECT_NEAR(met / double(samples), share, 4.5 * std::sqrt(share / samples)) << opening_.name;
}

/// ∮ I dω of what the engines interpolate, by midpoints.
double interpolated_flux(Photometry& photometry, const LightData& light) {
    constexpr int rings = 720, sectors = 720;
    double sum = 0;
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < sectors; ++k) {
            const float polar = (static_cast<float>(i) + 0.5f) * pi / rings,
                        azimuth = (static_cast<float>(k) + 0.5f) * 2 * pi / sectors;
            const vec3 local(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
            sum +=
                photometry.luminaire_intensity(light, photometry.luminaire_to_world(light, local)).x * std::sin(polar);
        }
    return sum * pi / rings * 2 * pi / sectors;
}

TEST_P(Openings, SendTheirWholeFluxThroughASphereRoundThem) {
    LightData far = light_;
    far.radius = 0;
    const double flux = interpolated_flux(photometry_, far);
    constexpr int places = 200000;
    for (const float distance : {1.05f * light_.radius, 3.0f}) {
        double sum = 0, squares = 0;
        for (int i = 0; i < places; ++i) {
            const vec3 outward = random_.direction();
            const LightSample arriving =
                photometry_.any_light_sample(light_, light_.position + distance * outward, random_.pair());
            const double lux = arriving.value.x * std::max(-dot(arriving.direction, outward), 0.0f);
            sum += lux;
            squares += lux * lux;
        }
        const double area = 4 * pi * distance * distance, mean = sum / places;
        const double error = std::sqrt((squares / places - mean * mean) / places);
        EXPECT_NEAR(mean * area / flux, 1, 4 * error / mean) << opening_.name << " at " << distance;
        EXPECT_LT(error / mean, 0.01) << opening_.name;
    }
}

TEST_P(Openings, LightFromFarAsAPointDoes) {
    LightData point = light_;
    point.radius = 0;
    const vec3 direction = normalize(vec3(0.3f, -0.8f, 0.4f)), place = light_.position + 100.0f * direction;
    const LightSample expected = photometry_.any_light_sample(point, place, vec2(0.5f));
    EXPECT_TRUE(expected.is_delta);
    EXPECT_NEAR(expected.value.x, photometry_.luminaire_intensity(point, direction).x / 1e4f, 1e-7);
    EXPECT_NEAR(expected.value.y / expected.value.x, 0.5, 1e-5);
    double sum = 0;
    constexpr int samples = 4096;
    for (int i = 0; i < samples; ++i) {
        const LightSample arriving = photometry_.any_light_sample(light_, place, random_.pair());
        EXPECT_FALSE(arriving.is_delta);
        sum += arriving.value.x / samples;
    }
    EXPECT_NEAR(sum / expected.value.x, 1, 0.01) << opening_.name;
    // Their points, each alone, make the same in the mean.
    double points = 0;
    for (int i = 0; i < samples; ++i) {
        const OpeningPoint one =
            opening_surface_point(light_.opening, light_.half_extent, face_weights(opening_), random_.pair());
        LightData stand_in = point;
        stand_in.position += photometry_.luminaire_to_world(light_, one.position);
        stand_in.weighted_normal = photometry_.luminaire_to_world(light_, one.weighted_normal);
        points += photometry_.any_light_sample(stand_in, place, vec2(0.5f)).value.x / samples;
    }
    EXPECT_NEAR(points / expected.value.x, 1, 0.06) << opening_.name;
}

TEST_P(Openings, AreSeenByRaysWithTheRadianceThatSamplingFinds) {
    const vec3 place = light_.position + vec3(0.4f, -0.9f, 0.3f);
    for (int i = 0; i < 200; ++i) {
        const LightSample arriving = photometry_.any_light_sample(light_, place, random_.pair());
        const float t = photometry_.any_light_intersect(light_, place, arriving.direction);
        if (t < 0) continue;  // at an edge
        EXPECT_NEAR(t, arriving.distance, 2e-3f * t);
        EXPECT_NEAR(photometry_.any_light_radiance(light_, arriving.direction).x / (arriving.value.x * arriving.pdf), 1,
                    1e-3);
        EXPECT_NEAR(photometry_.any_light_pdf(light_, place, arriving.direction) / arriving.pdf, 1, 0.02);
    }
    EXPECT_LT(photometry_.any_light_intersect(light_, place, normalize(place - light_.position)), 0.0f);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Openings, testing::Range<std::size_t>(0, openings.size()),
                         [](const auto& info) { return std::string(openings[info.param].name); });

TEST(Luminaire, InterpolatesBilinearlyAndSendsNothingOutsideItsAngles) {
    Photometry photometry;
    photometry.table = {2, 3, 0.5f, 1.5f, 0, 1, 2 * pi, /**/ 1, 3, /**/ 2, 6, /**/ 1, 3};
    EXPECT_FLOAT_EQ(photometry.luminaire_relative_intensity(0, 0.5f, 0), 1);
    EXPECT_FLOAT_EQ(photometry.luminaire_relative_intensity(0, 1.0f, 0), 2);
    EXPECT_FLOAT_EQ(photometry.luminaire_relative_intensity(0, 1.0f, 0.5f), 3);
    EXPECT_FLOAT_EQ(photometry.luminaire_relative_intensity(0, 1.5f, 1), 6);
    EXPECT_EQ(photometry.luminaire_relative_intensity(0, 0.49f, 1), 0);
    EXPECT_EQ(photometry.luminaire_relative_intensity(0, 1.51f, 1), 0);
    photometry.table = {2, 1, 0, 2, 0, 4, 8};
    EXPECT_FLOAT_EQ(photometry.luminaire_relative_intensity(0, 1, 5), 6);
}

TEST(Luminaire, JumpsWhereTwoPlanesShareAnAngle) {
    Photometry photometry;
    photometry.table = {2, 6, 0, 3, 0, 1, 1, 5, 5, 2 * pi, /**/ 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1};
    EXPECT_FLOAT_EQ(photometry.luminaire_relative_intensity(0, 1, 0.99f), 1);
    EXPECT_FLOAT_EQ(photometry.luminaire_relative_intensity(0, 1, 1.01f), 0);
    EXPECT_FLOAT_EQ(photometry.luminaire_relative_intensity(0, 1, 4.99f), 0);
    EXPECT_FLOAT_EQ(photometry.luminaire_relative_intensity(0, 1, 5.01f), 1);
}

TEST(Luminaire, AnOpeningSendsNothingToWhatIsInsideIt) {
    Photometry table = photometry();
    for (const Opening& opening : openings) {
        if (opening_is_flat(opening.half_extent)) continue;
        const LightData light = luminaire(opening);
        EXPECT_EQ(table.any_light_sample(light, light.position, vec2(0.3f)).value, vec3(0)) << opening.name;
        EXPECT_LT(table.any_light_intersect(light, light.position, vec3(1, 0, 0)), 0) << opening.name;
    }
}

TEST(Luminaire, MirroredNodesTurnAzimuthsRound) {
    Photometry table = photometry();
    LightData light = luminaire(openings[0]);
    light.axis = vec3(0, -1, 0);
    light.tangent = vec3(1, 0, 0);
    const vec3 towards = normalize(vec3(0.2f, -0.5f, -0.8f));  // C90 is −z
    EXPECT_GT(table.luminaire_to_local(light, towards).y, 0);
    light.opening |= opening_mirrored;
    EXPECT_LT(table.luminaire_to_local(light, towards).y, 0);
    EXPECT_EQ(table.luminaire_to_world(light, table.luminaire_to_local(light, vec3(1, 2, 3))), vec3(1, 2, 3));
}

}  // namespace
}  // namespace heliodon::shading
