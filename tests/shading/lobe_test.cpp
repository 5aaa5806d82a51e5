#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "quadrature_points.h"
#include "shading/plane_lobe.h"
#include "shading/reflected_light.h"

namespace heliodon::shading {
namespace {

using tests::direction;

/// ∫ f dω by midpoints in height and azimuth: over the sphere, or what is above the plane.
template <class Value>
auto integral(double lowest, const Value& f) {
    constexpr int heights = 800, turns = 360;
    decltype(f(vec3())) sum{};
    for (int i = 0; i < heights; ++i) {
        const double z = lowest + (1 - lowest) * (i + 0.5) / heights;
        for (int k = 0; k < turns; ++k) {
            const double weight = (1 - lowest) / heights * 2 * std::numbers::pi / turns;
            sum += f(direction(static_cast<float>(z), static_cast<float>(2 * std::numbers::pi * (k + 0.5) / turns))) * weight;
        }
    }
    return sum;
}
template <class Value>
auto over_sphere(const Value& f) { return integral(-1, f); }
template <class Value>
auto over_plane(const Value& f) { return integral(0, f); }

/// What goes through the plane, and its direction on the average.
struct Flux {
    double all = 0;
    glm::dvec3 mean{0};
    double low = 0;  ///< share within 30° of the plane
};
template <class Radiance>
Flux flux_of(const Radiance& times_cosine) {
    Flux flux;
    flux.all = over_plane(times_cosine);
    flux.mean = over_plane([&](vec3 d) { return glm::dvec3(d) * times_cosine(d); }) / flux.all;
    flux.low = over_plane([&](vec3 d) { return d.z < 0.5f ? times_cosine(d) : 0.0; }) / flux.all;
    return flux;
}
/// Of a lobe of mean `mean` and light 1.
Flux flux_of_lobe(vec3 mean) {
    const float sum = std::max(length(mean), 1e-6f);
    return flux_of([&](vec3 d) { return double(lobe_density(lobe_concentration(sum), dot(mean, d) / sum) * d.z); });
}

TEST(SphericalLobe, SharesItsLightAmongAllDirectionsAndHasItsMean) {
    for (const double concentration : {0.01, 0.5, 3.0, 20.0, 60.0}) {
        const auto k = static_cast<float>(concentration);
        EXPECT_NEAR(over_sphere([&](vec3 d) { return double(lobe_density(k, d.z)); }), 1, 2e-3);
        const double mean = over_sphere([&](vec3 d) { return double(lobe_density(k, d.z) * d.z); });
        EXPECT_NEAR(mean, 1 / std::tanh(concentration) - 1 / concentration, 2e-3);
        EXPECT_NEAR(lobe_concentration(static_cast<float>(mean)) / concentration, 1, concentration < 1 ? 0.1 : 0.05);
    }
}

TEST(SphericalLobe, SeenThroughAConeItIsAsWideAsBoth) {
    EXPECT_FLOAT_EQ(lobe_through_cone(20, 0), 20);
    EXPECT_FLOAT_EQ(lobe_through_cone(20, 0.1f), 10);  // a cone of 2/κ alone is as wide
    EXPECT_NEAR(lobe_through_cone(1e6f, 0.1f), 20, 1e-3);
}

TEST(SphericalLobe, ItsClampedCosineIsWithinTwoHundredths) {
    for (const float concentration : {0.5f, 1.0f, 3.0f, 10.0f, 60.0f, 500.0f})
        for (float cosine = -1; cosine <= 1; cosine += 0.25f) {
            const vec3 axis = direction(cosine);
            const double exact = over_plane([&](vec3 d) { return double(lobe_density(concentration, dot(axis, d)) * d.z); });
            EXPECT_NEAR(lobe_clamped_cosine(concentration, cosine), exact, 0.021) << concentration << " at " << cosine;
        }
}

TEST(PlaneLobe, OfAnEvenFluxIsEvenRadiance) {
    const PlaneLobe even = plane_lobe({0, 2.0 / 3});
    EXPECT_NEAR(glm::length(even.mean), 0, 1e-3);
    EXPECT_NEAR(even.clamped_cosine, 0.25, 1e-3);
}

TEST(PlaneLobe, SendsItsFluxWhereItWasAskedTo) {
    for (const glm::dvec2 asked : {glm::dvec2(-0.73, 0.44), {-0.35, 0.46}, {-0.9, 0.32}, {0, 0.8}, {0.3, 0.7}, {-0.59, 0.79}, {-0.96, 0.26}}) {
        const PlaneLobe lobe = plane_lobe(asked);
        const Flux flux = flux_of_lobe(vec3(lobe.mean.x, 0, lobe.mean.y));
        EXPECT_NEAR(flux.mean.x, asked.x, 0.02);
        EXPECT_NEAR(flux.mean.z, asked.y, 0.02);
        EXPECT_NEAR(lobe.clamped_cosine / flux.all, 1, 0.02) << asked.x << " " << asked.y;
    }
}

/// What the model's GGX lobe sends on of light from `wi`, and where.
Flux reflected_specularly(const Surface& surface, vec3 wi) {
    const BsdfLobes lobes = bsdf_prepare(surface, wi);
    return flux_of([&](vec3 d) { return double(bsdf_evaluate_prepared(surface, lobes, wi, d).x); });
}

TEST(ReflectedLight, GoesOnAsMuchAndWhereTheGgxLobeSendsIt) {
    for (const float roughness : {0.4f, 0.6f, 0.8f})
        for (const float mu : {0.15f, 0.26f, 0.5f, 0.8f}) {
            // A dielectric without a diffuse layer, so that all of its albedo is specular.
            const Surface surface = tests::standard_surface(vec3(0), 0, roughness);
            const vec3 mean_view = direction(even_field_cosine);
            const vec3 albedo = bsdf_albedo(surface, mean_view);
            const ReflectedLight light = reflected_light(albedo, albedo.x, ggx_alpha(roughness), direction(mu, 0.7f));
            const Flux exact = reflected_specularly(surface, direction(mu, 0.7f));
            EXPECT_NEAR(light.specular.x / exact.all, 1, 0.03) << roughness << " at " << mu;
            EXPECT_EQ(light.diffuse, vec3(0));
            const Flux lobe = flux_of_lobe(light.mean);
            EXPECT_NEAR(lobe.all / light.clamped_cosine, 1, 0.03) << roughness << " at " << mu;
            EXPECT_NEAR(lobe.low, exact.low, 0.05) << roughness << " at " << mu;
            for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(lobe.mean[axis], exact.mean[axis], 0.03) << roughness << " at " << mu;
        }
}

TEST(ReflectedLight, OfAGrazedRoughDielectricIsBrightestTowardsItsPlane) {
    const vec3 lobe = reflected_lobe(0.259f, 0.36f, 1);  // 75° from the normal
    const float sum = std::hypot(lobe.x, lobe.y);
    EXPECT_NEAR(lobe_concentration(sum), 4.5f, 0.1f);
    EXPECT_NEAR(std::asin(lobe.y / sum) * 180 / std::numbers::pi, -20, 1) << "degrees above its plane";
}

TEST(ReflectedLight, OfAMetalIsColouredAndOfADielectricWhite) {
    const vec3 gold(1, 0.77f, 0.34f);
    EXPECT_NEAR(length(specular_part(gold, dot(gold, vec3(1.0f / 3))) - gold), 0, 1e-6);
    EXPECT_EQ(specular_part(vec3(0.5f, 0.3f, 0.2f), 0.05f), vec3(0.05f));
    for (const float mean : {0.1f, 0.35f, 0.5f, 0.65f}) {
        const vec3 part = specular_part(gold, mean);
        EXPECT_NEAR((part.x + part.y + part.z) / 3, mean, 1e-6) << "none is lost";
        EXPECT_TRUE(glm::all(glm::lessThanEqual(part, gold)));
    }
    const Surface painted = tests::standard_surface(vec3(0.8f, 0.1f, 0.1f), 0, 0.5f);
    const vec3 albedo = bsdf_albedo(painted, direction(even_field_cosine));
    const float specular = bsdf_specular_albedo(painted, direction(even_field_cosine)).x;
    const ReflectedLight light = reflected_light(albedo, specular, ggx_alpha(0.5f), direction(0.3f));
    EXPECT_FLOAT_EQ(light.specular.x, light.specular.y);
    EXPECT_GT(light.diffuse.x, 5 * light.diffuse.y);
}

TEST(ReflectedLight, IsAtEachAngleWhatTheSurfaceReflects) {
    for (const float metallic : {0.0f, 1.0f})
        for (const float mu : {0.1f, 0.3f, 0.6f, 0.9f}) {
            const Surface surface = tests::standard_surface(vec3(0.6f, 0.4f, 0.3f), metallic, 0.5f);
            const vec3 view = direction(even_field_cosine);
            const vec3 specular = bsdf_specular_albedo(surface, view);
            const ReflectedLight light = reflected_light(bsdf_albedo(surface, view), dot(specular, vec3(1.0f / 3)), ggx_alpha(0.5f), direction(mu));
            const vec3 exact = bsdf_albedo(surface, direction(mu));
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(light.diffuse[c] + light.specular[c], exact[c], metallic > 0 ? 0.025 : 0.015) << metallic << " at " << mu;  // light between facets goes by Fresnel too
        }
    const ReflectedLight matt = reflected_light(vec3(0.5f), 0, 1, direction(0.1f));
    EXPECT_EQ(matt.specular, vec3(0));
    EXPECT_EQ(matt.diffuse, vec3(0.5f));
}

}  // namespace
}  // namespace heliodon::shading
