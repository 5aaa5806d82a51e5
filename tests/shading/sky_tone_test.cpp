#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "quadrature_points.h"
#include "shading/environment.h"
#include "shading/octahedral.h"
#include "shading/random.h"
#include "shading/sky.h"
#include "shading/tone.h"

namespace heliodon::shading {
namespace {

constexpr float half_pi = 1.57079633f;

void expect_near(vec3 a, vec3 b, float tolerance) {
    EXPECT_LT(length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Sky, AzimuthRunsClockwiseFromNorthWhichIsMinusZ) {
    expect_near(direction_from_azimuth(0, 0, 0), vec3(0, 0, -1), 1e-6f);
    expect_near(direction_from_azimuth(half_pi, 0, 0), vec3(1, 0, 0), 1e-6f);
    expect_near(direction_from_azimuth(0, half_pi, 0), vec3(0, 1, 0), 1e-6f);
    // North turned a quarter clockwise seen from above lies where east was.
    expect_near(direction_from_azimuth(0, 0, half_pi), vec3(1, 0, 0), 1e-6f);
}

TEST(Sky, ImagesCentreColumnLooksToMinusZ) {
    EXPECT_NEAR(sky_uv(vec3(0, 0, -1), 0).x, 0.5f, 1e-6f);
    EXPECT_NEAR(sky_uv(vec3(1, 0, 0), 0).x, 0.75f, 1e-6f);
    EXPECT_NEAR(sky_uv(vec3(1, 0, 0), half_pi).x, 0.5f, 1e-6f);
    EXPECT_NEAR(sky_uv(vec3(0, 1, 0), 0).y, 0.0f, 1e-6f);
    EXPECT_NEAR(sky_uv(vec3(0, -1, 0), 0).y, 1.0f, 1e-6f);
}

TEST(Sky, DirectionAndImagePlaceAreInverse) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const vec3 w = sample_uniform_sphere(vec2(tests::cube_point(i)));
        expect_near(sky_direction(sky_uv(w, 0.4f), 0.4f), w, 2e-5f);
    }
}

TEST(Sky, EvenDensityOverTheImageIntegratesToOneOverTheSphere) {
    double sum = 0;
    constexpr int samples = 100000;
    for (int i = 0; i < samples; ++i) {
        const float z = -1 + 2 * (i + 0.5f) / samples;
        sum += sky_solid_angle_pdf(1.0f, vec2(0.5f, std::acos(z) / pi)) * 4 * pi / samples;
    }
    EXPECT_NEAR(sum, 1.0, 2e-3);
}

TEST(Tone, SrgbEncodingIsTheStandardsAndInverse) {
    EXPECT_NEAR(srgb_encode(0.5f), 0.735357f, 1e-6f);
    EXPECT_NEAR(srgb_encode(0.001f), 0.01292f, 1e-7f);
    EXPECT_EQ(srgb_encode(-1), 0.0f);
    EXPECT_NEAR(srgb_encode(7), 1.0f, 1e-6f);
    for (int i = 0; i <= 255; ++i) EXPECT_NEAR(srgb_encode(srgb_decode(i / 255.0f)), i / 255.0f, 2e-6f);
}

TEST(Octahedral, EncodingIsInverseAndStaysInTheSquare) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const vec3 v = sample_uniform_sphere(vec2(tests::cube_point(i)));
        const vec2 e = octahedral_encode(v);
        EXPECT_LE(std::max(std::abs(e.x), std::abs(e.y)), 1.0f);
        expect_near(octahedral_decode(e), v, 1e-6f);
    }
    expect_near(octahedral_decode(octahedral_encode(vec3(0, 0, -1))), vec3(0, 0, -1), 1e-6f);
}

TEST(Environment, PrefilterDensityIntegratesToOneAndWeightsAreCosines) {
    // The mean of weight/weight is the sky itself; the mean of 1/pdf over the upper half is its solid angle.
    double solid_angle = 0;
    constexpr uint count = 1 << 14;
    for (uint i = 0; i < count; ++i) {
        const PrefilterSample sample = prefilter_sample(hammersley(i, count), 1.0f);
        EXPECT_NEAR(sample.weight, std::max(sample.direction.z, 0.0f), 0.0f);
        if (sample.weight > 0) solid_angle += 1 / (sample.pdf * double(count));
    }
    EXPECT_NEAR(solid_angle / (2 * pi), 1.0, 0.01);
}

TEST(Random, NumbersAreUniformIndependentAndReproducible) {
    double mean = 0, square = 0, product = 0;
    constexpr int samples = 1 << 16;
    for (uint i = 0; i < samples; ++i) {
        const vec4 u = random4(i, 3, 5, 1);
        for (int c = 0; c < 4; ++c) {
            ASSERT_GE(u[c], 0.0f);
            ASSERT_LT(u[c], 1.0f);
        }
        mean += u.x / samples;
        square += u.y * u.y / samples;
        product += (u.x - 0.5) * (random4(i + 1, 3, 5, 1).x - 0.5) / samples;
    }
    EXPECT_NEAR(mean, 0.5, 0.005);
    EXPECT_NEAR(square, 1 / 3.0, 0.005);
    EXPECT_NEAR(product, 0.0, 0.002);
    EXPECT_EQ(random4(1, 2, 3, 4), random4(1, 2, 3, 4));
    EXPECT_NE(random4(1, 2, 3, 4), random4(1, 2, 3, 5));
    EXPECT_LT(uint_to_unit_float(0xffffffffu), 1.0f);
}

TEST(Sampling, FramesAreOrthonormalAndRightHanded) {
    for (std::uint32_t i = 0; i < 500; ++i) {
        const vec3 n = i == 0 ? vec3(0, 0, -1) : sample_uniform_sphere(vec2(tests::cube_point(i)));
        const Frame frame = frame_from_normal(n);
        expect_near(cross(frame.tangent, frame.bitangent), n, 1e-6f);
        EXPECT_NEAR(dot(frame.tangent, frame.bitangent), 0.0f, 1e-6f);
        const vec3 v(0.1f, -0.7f, 0.4f);
        expect_near(to_local(frame, to_world(frame, v)), v, 1e-6f);
    }
}

TEST(Sampling, WarpsHaveTheMeansOfTheirDensities) {
    double cosine = 0, hemisphere = 0, cone = 0, disk = 0;
    constexpr std::uint32_t samples = 1 << 15;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const vec2 u(tests::cube_point(i));
        cosine += sample_cosine_hemisphere(u).z / double(samples);
        hemisphere += sample_uniform_hemisphere(u).z / double(samples);
        cone += sample_cone(u, 0.2f).z / double(samples);
        const vec2 d = sample_disk(u);
        disk += dot(d, d) / double(samples);
    }
    EXPECT_NEAR(cosine, 2 / 3.0, 1e-3);
    EXPECT_NEAR(hemisphere, 0.5, 1e-3);
    EXPECT_NEAR(cone, 0.9, 1e-4);
    EXPECT_NEAR(disk, 0.5, 1e-3);
    EXPECT_FLOAT_EQ(power_heuristic(3, 1), 0.9f);
    EXPECT_FLOAT_EQ(power_heuristic(3, 1) + power_heuristic(1, 3), 1.0f);
    EXPECT_EQ(power_heuristic(0, 0), 0.0f);
}

}  // namespace
}  // namespace heliodon::shading
