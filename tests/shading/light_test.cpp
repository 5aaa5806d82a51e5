#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "quadrature_points.h"
#include "shading/light.h"

namespace heliodon::shading {
namespace {

using tests::cube_point;

LightData make_light(uint type, float radius = 0) {
    LightData light{};
    light.type = type;
    light.radius = radius;
    light.position = vec3(1, 3, -2);
    light.axis = normalize(vec3(0.2f, -1, 0.1f));
    light.intensity = vec3(100, 50, 25);
    light.cos_inner = std::cos(0.35f);
    light.cos_outer = std::cos(0.6f);
    return light;
}

/// ∮ I dω by rings about the light's axis.
double integrated_flux(const LightData& light) {
    constexpr int rings = 200000;
    const Frame frame = frame_from_normal(light.axis);
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const float z = -1 + 2 * (i + 0.5f) / rings;
        sum += light_intensity(light, to_world(frame, tests::direction(z))).x;
    }
    return sum * 4 * std::numbers::pi / rings;
}

TEST(Light, FluxIsTheIntegralOfTheIntensity) {
    for (uint type : {light_type_point, light_type_spot, light_type_lambertian}) {
        const LightData light = make_light(type);
        EXPECT_NEAR(integrated_flux(light) / light_flux(light).x, 1.0, 1e-4) << type;
    }
}

TEST(Light, SpotFalloffIsTheSquaredRampOfCosines) {
    const float inner = std::cos(0.3f), outer = std::cos(0.5f);
    EXPECT_EQ(spot_falloff(1.0f, inner, outer), 1.0f);
    EXPECT_EQ(spot_falloff(inner, inner, outer), 1.0f);
    EXPECT_EQ(spot_falloff(outer - 1e-4f, inner, outer), 0.0f);
    EXPECT_NEAR(spot_falloff(0.5f * (inner + outer), inner, outer), 0.25f, 1e-5f);
    EXPECT_EQ(spot_falloff(0.99f, 0.9f, 0.9f), 1.0f);
    EXPECT_EQ(spot_falloff(0.89f, 0.9f, 0.9f), 0.0f);
}

// External truth, CIE 171:2006 test case 5.2: a Lambertian point source of 1000 cd at height 3 m.
TEST(Light, LambertianPointSourceLightsTheFloorAsCie171Says) {
    LightData light{};
    light.type = light_type_lambertian;
    light.position = vec3(0, 3, 0);
    light.axis = vec3(0, -1, 0);
    light.intensity = vec3(1000);
    const float points[][3] = {
        {0, 0, 111.11f}, {0.5f, 0, 105.21f}, {1, 0, 90.02f}, {1.5f, 0.5f, 68.06f}, {1.5f, 1.5f, 49.39f}};
    for (const auto& p : points) {
        const LightSample sample = light_sample(light, vec3(p[0], 0, p[1]), vec2(0.5f));
        EXPECT_TRUE(sample.is_delta);
        const float d2 = 9 + p[0] * p[0] + p[1] * p[1];
        EXPECT_NEAR(sample.value.x * sample.direction.y, 1000 * 9 / (d2 * d2), 1e-3f);  // E = I0 h²/d⁴
        EXPECT_NEAR(sample.value.x * sample.direction.y / p[2], 1.0f, 3e-4f);           // as printed there
    }
}

/// Irradiance on a plane at `point` with normal `n`.
double irradiance(const LightData& light, vec3 point, vec3 n) {
    double sum = 0;
    constexpr std::uint32_t samples = 1 << 14;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const LightSample sample = light_sample(light, point, vec2(cube_point(i)));
        sum += sample.value.x * std::max(0.0f, dot(sample.direction, n)) / samples;
    }
    return sum;
}

TEST(Light, SphereLightsOfAnyRadiusGiveTheInverseSquareLaw) {
    // A uniform sphere wholly above the horizon lights a plane as its centre would: E = I cos θ/d².
    for (float radius : {0.01f, 0.3f, 1.5f}) {
        const LightData light = make_light(light_type_point, radius);
        const vec3 point(0.4f, 0, -1), n(0, 1, 0);
        const vec3 to = light.position - point;
        EXPECT_NEAR(irradiance(light, point, n) / (100 * normalize(to).y / dot(to, to)), 1.0, 1e-3) << radius;
    }
}

TEST(Light, DiscsInTheSkyGiveTheirIlluminance) {
    for (float radius : {0.0046f, 0.1f, 1.0f}) {
        LightData light = make_light(light_type_directional, radius);
        EXPECT_NEAR(irradiance(light, vec3(0), -light.axis) / 100, 1.0, 1e-3) << radius;
        const LightSample sample = light_sample(light, vec3(0), vec2(0.3f, 0.7f));
        EXPECT_FALSE(sample.is_delta);
        EXPECT_EQ(light_intersect(light, vec3(5), sample.direction), light_distance_infinite);
        EXPECT_LT(light_intersect(light, vec3(5), light.axis), 0.0f);
    }
}

TEST(Light, SamplesOfAreaLightsLieOnThemAndCarryTheirDensity) {
    const LightData light = make_light(light_type_spot, 0.25f);
    const vec3 point(0.5f, 0.2f, -1.7f);
    for (std::uint32_t i = 0; i < 500; ++i) {
        const LightSample sample = light_sample(light, point, vec2(cube_point(i)));
        EXPECT_NEAR(length(point + sample.direction * sample.distance - light.position), 0.25f, 1e-4f);
        EXPECT_NEAR(light_intersect(light, point, sample.direction), sample.distance, 2e-3f);
        EXPECT_FLOAT_EQ(sample.pdf, light_pdf(light, point));
        const vec3 radiance = light_radiance(light, sample.direction);
        EXPECT_NEAR(sample.value.x * sample.pdf, radiance.x, 1e-3f * radiance.x + 1e-6f);
    }
}

TEST(Light, DensityIntegratesToOneOverTheCone) {
    const LightData light = make_light(light_type_point, 0.8f);
    const vec3 point(0, 1, 0);
    EXPECT_NEAR(light_pdf(light, point) * 2 * pi * light_cone(light, point), 1.0f, 1e-5f);
}

TEST(Light, PointsInsideASphereLightReceiveNothing) {
    const LightData light = make_light(light_type_point, 1.0f);
    const LightSample sample = light_sample(light, light.position + vec3(0.5f, 0, 0), vec2(0.5f));
    EXPECT_EQ(sample.value, vec3(0));
    EXPECT_EQ(light_pdf(light, light.position), 0.0f);
    EXPECT_LT(light_intersect(light, light.position, vec3(0, 1, 0)), 0.0f);
}

TEST(Light, HolesInTheTableGiveNothing) {
    EXPECT_EQ(light_sample(make_light(light_type_none), vec3(0), vec2(0.5f)).value, vec3(0));
}

// Veach's sphere lights (external truth, "Light transport"): equal power whatever the radius.
TEST(Light, VeachsSphereLightsHaveEqualPower) {
    const float radii[] = {0.0333f, 0.1f, 0.3f, 0.9f}, radiances[] = {901.803f, 100.0f, 11.1111f, 1.23457f};
    for (int i = 0; i < 4; ++i) {
        LightData light = make_light(light_type_point, radii[i]);
        light.intensity = vec3(pi * 0.01f * 100.0f);
        EXPECT_NEAR(light_radiance(light, vec3(0, -1, 0)).x / radiances[i], 1.0f, 1e-4f);
    }
}

}  // namespace
}  // namespace heliodon::shading
