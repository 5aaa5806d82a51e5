#include "shading/lobe_cone.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "quadrature_points.h"

namespace heliodon::shading {
namespace {

using tests::direction;
constexpr double turn = 2 * std::numbers::pi;

/// Mean of `value` of the directions of cone `cone` over even shifts.
template <class Value>
double mean_over_shifts(uint cone, uint set, uint sets, const Value& value) {
    constexpr int points = 256;
    double sum = 0;
    for (int i = 0; i < points; ++i)
        for (int k = 0; k < points; ++k)
            sum += value(diffuse_cone(cone, set, sets, vec2((i + 0.5f) / points, (k + 0.5f) / points), 1).direction);
    return sum / (points * double(points));
}

/// Which of the nine cells a direction lies in.
uint cell_of(vec3 d) {
    const bool inner = d.x * d.x + d.y * d.y < 1.0f / 3.0f;
    const double turns = std::atan2(d.y, d.x) / turn;
    const double azimuth = turns < 0 ? turns + 1 : turns;
    return inner ? static_cast<uint>(azimuth * 3) : 3u + static_cast<uint>(azimuth * 6);
}

TEST(DiffuseCones, WeightsAddToOneAndSolidAnglesToTheHemisphere) {
    for (const auto [sets, share] : {std::pair(1u, 1.0f), std::pair(2u, 1.0f), std::pair(4u, 1.0f), std::pair(7u, 0.125f)}) {
        double weight = 0, solid_angle = 0;
        for (uint set = 0; set < sets; ++set)
            for (uint cone = 0; cone < cones_per_set; ++cone) {
                const Cone c = diffuse_cone(cone, set, sets, vec2(0.3f, 0.8f), share);
                weight += c.weight;
                solid_angle += c.one_minus_cos;
                EXPECT_NEAR(length(c.direction), 1.0f, 1e-6f);
                EXPECT_NEAR(1 / std::sqrt(1 + c.tan_half_angle * c.tan_half_angle), 1 - c.one_minus_cos, 1e-6f);
            }
        EXPECT_NEAR(weight, 1.0, 1e-6);
        EXPECT_NEAR(solid_angle, share, 1e-6);
    }
}

TEST(DiffuseCones, EachHasACellOfANinthOfTheProjectedSolidAngle) {
    // The projected solid angle of the directions that lie in a cell, by the disk's area elements.
    std::array<double, cones_per_set> area{};
    constexpr int rings = 600, sectors = 720;
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < sectors; ++k) {
            const float sin2 = (i + 0.5f) / rings;
            area[cell_of(direction(std::sqrt(1 - sin2), turn * (k + 0.5f) / sectors))] += 1.0 / (rings * sectors);
        }
    for (uint cone = 0; cone < cones_per_set; ++cone) {
        EXPECT_NEAR(area[cone] * std::numbers::pi, std::numbers::pi / 9, 1e-6);
        for (uint set = 0; set < 4; ++set)
            for (float shift : {0.0f, 0.37f, 0.999f})
                EXPECT_EQ(cell_of(diffuse_cone(cone, set, 4, vec2(shift, 1 - shift - 0.001f), 1).direction), cone);
    }
}

TEST(DiffuseCones, WithoutAShiftOneSetPointsAtTheMiddlesOfTheCells) {
    const Cone inner = diffuse_cone(0, 0, 1, vec2(0), 1), outer = diffuse_cone(3, 0, 1, vec2(0), 1);
    const auto middle = [](double sin2, double azimuth) {
        return direction(static_cast<float>(std::sqrt(1 - sin2)), static_cast<float>(azimuth));
    };
    EXPECT_NEAR(length(inner.direction - middle(1.0 / 6, turn / 6)), 0.0f, 1e-6f);
    EXPECT_NEAR(length(outer.direction - middle(2.0 / 3, turn / 12)), 0.0f, 1e-6f);
}

TEST(DiffuseCones, TheirMeanOverShiftsIsTheCosineWeightedIntegral) {
    // (1/π) ∫ f cos θ dω: 1 → 1, z → 2/3, z² → 1/2, x² → 1/4, odd functions of x or y → 0.
    const auto sum = [](uint sets, const auto& value) {
        double total = 0;
        for (uint cone = 0; cone < cones_per_set; ++cone)
            total += mean_over_shifts(cone, sets - 1, sets, value) / cones_per_set;
        return total;
    };
    for (uint sets : {1u, 4u}) {
        EXPECT_NEAR(sum(sets, [](vec3 d) { return d.z; }), 2.0 / 3, 1e-4);
        EXPECT_NEAR(sum(sets, [](vec3 d) { return d.z * d.z; }), 0.5, 1e-5);
        EXPECT_NEAR(sum(sets, [](vec3 d) { return d.x * d.x; }), 0.25, 1e-5);
        EXPECT_NEAR(sum(sets, [](vec3 d) { return d.x; }), 0.0, 1e-5);
        EXPECT_NEAR(sum(sets, [](vec3 d) { return d.x * d.y; }), 0.0, 1e-5);
        EXPECT_NEAR(sum(sets, [](vec3 d) { return d.y * d.z; }), 0.0, 1e-5);
    }
    // One cell alone: ∫ z over its ring, 2 (1 − (2/3)^1.5)/3 · 3 inside.
    const double boundary = std::pow(2.0 / 3, 1.5);
    EXPECT_NEAR(mean_over_shifts(1, 0, 1, [](vec3 d) { return d.z; }), 2 * (1 - boundary), 1e-5);
    EXPECT_NEAR(mean_over_shifts(5, 0, 1, [](vec3 d) { return d.z; }), boundary, 1e-4);
}

TEST(DiffuseCones, FixedSetsComeNearerToASmoothIntegralTheMoreTheyAre) {
    // A lobe off the normal; what each count of fixed cones gives for its irradiance.
    const auto radiance = [](vec3 d) { return std::exp(-8.0 * (1 - dot(d, normalize(vec3(0.5f, 0.2f, 0.6f))))); };
    double exact = 0;
    for (uint cone = 0; cone < cones_per_set; ++cone) exact += mean_over_shifts(cone, 0, 1, radiance) / cones_per_set;
    const auto error = [&](uint sets) {
        double sum = 0;
        for (uint set = 0; set < sets; ++set)
            for (uint cone = 0; cone < cones_per_set; ++cone) {
                const Cone c = diffuse_cone(cone, set, sets, vec2(0), 1);
                sum += c.weight * radiance(c.direction);
            }
        return std::abs(sum / exact - 1);
    };
    EXPECT_LT(error(1), 0.2);
    EXPECT_LT(error(4), 0.03);
    EXPECT_LT(error(16), 0.005);
}

/// A lobe by 2¹⁷ of its samples: directions below the surface for eta > 0, mirrored ones for eta = 0.
struct SampledLobe {
    glm::dvec3 mean{0};  // of the directions; its length is their mean cosine to it
    double energy = 0, mean_square = 0;
    void add(vec3 wi, double share, double density) {
        energy += share;
        mean += share * glm::dvec3(wi);
        mean_square += share * density;
    }
    [[nodiscard]] double one_minus_cos() const { return energy * energy / mean_square / turn; }
    [[nodiscard]] double mean_cosine() const { return length(mean) / energy; }
};
template <class Visit>
void visit_lobe(vec3 wo, float alpha, float eta, const Visit& visit) {
    constexpr std::uint32_t samples = 1 << 17;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const vec3 h = ggx_sample_visible_normal(wo, alpha, vec2(tests::cube_point(i)));
        vec3 wi = 2.0f * dot(wo, h) * h - wo;
        double share = 0, pdf = 0;
        if (eta == 0.0f && wi.z > 0.0f) {
            share = ggx_reflection(wo, wi, h, alpha) / ggx_reflection_pdf(wo, h, alpha);
            pdf = ggx_reflection_pdf(wo, h, alpha);
        } else if (eta > 0.0f && refract_about(wo, h, eta, wi) && wi.z < 0.0f) {
            pdf = ggx_refraction_pdf(wo, wi, h, alpha, eta);
            share = ggx_g1(-wi.z, alpha);  // what of the visible facets' light leaves unmasked
        }
        if (share > 0) visit(wi, share / samples, share * pdf);
    }
}
SampledLobe sampled_lobe(vec3 wo, float alpha, float eta) {
    SampledLobe lobe;
    visit_lobe(wo, alpha, eta, [&](vec3 wi, double share, double density) { lobe.add(wi, share, density); });
    return lobe;
}
/// With Schlick's factor.
SampledLobe sampled_lobe_of(vec3 wo, float alpha, float f0) {
    SampledLobe lobe;
    visit_lobe(wo, alpha, 0, [&](vec3 wi, double share, double density) {
        const double fresnel = fresnel_schlick(vec3(f0), 1, dot(wo, normalize(wo + wi))).x;
        lobe.add(wi, share * fresnel, density * fresnel);
    });
    return lobe;
}
double degrees_between(glm::dvec3 a, glm::dvec3 b) {
    return std::atan2(length(cross(a, b)), dot(a, b)) * 360 / turn;
}

TEST(SpecularCone, PointsWhereTheReflectionsOfGgxDoOnAverage) {
    for (float roughness : {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.8f, 1.0f})
        for (float mu : {1.0f, 0.9f, 0.7f, 0.5f, 0.3f, 0.1f}) {
            const vec3 wo = direction(mu, 0.7f);
            const float alpha = ggx_alpha(roughness);
            const Cone cone = specular_cone(wo, alpha);
            const SampledLobe lobe = sampled_lobe(wo, alpha, 0);
            SCOPED_TRACE(::testing::Message() << "roughness " << roughness << " mu " << mu);
            EXPECT_LE(degrees_between(cone.direction, lobe.mean), 0.15);
            // An even cone's mean cosine is 1 − one_minus_cos/2. GGX's long tail lies outside the cone, and seen from
            // low the lobe is a strip above the horizon.
            EXPECT_NEAR(1 - 0.5 * cone.one_minus_cos, lobe.mean_cosine(), mu >= 0.7f ? 0.09 : 0.161);
            // The horizon cuts the widest ones seen from low.
            EXPECT_NEAR(cone.one_minus_cos / lobe.one_minus_cos(), 1.0, mu > 0.1f ? 0.015 : 0.03);
            EXPECT_EQ(cone.weight, 1.0f);
        }
}

TEST(SpecularCone, LooksAheadWhereFresnelHasARoughDielectricReflect) {
    for (float roughness : {0.2f, 0.4f, 0.6f, 0.8f, 1.0f})
        for (float mu : {0.9f, 0.5f, 0.2f, 0.1f})
            for (float f0 : {0.02f, 0.04f, 0.1f, 0.25f, 0.6f}) {
                const vec3 wo = direction(mu, 0.7f);
                const float alpha = ggx_alpha(roughness);
                const Cone cone = specular_cone(wo, alpha, f0, ggx_albedo_split(mu, alpha));
                const SampledLobe lobe = sampled_lobe_of(wo, alpha, f0);
                SCOPED_TRACE(::testing::Message() << "roughness " << roughness << " mu " << mu << " F0 " << f0);
                EXPECT_LE(degrees_between(cone.direction, lobe.mean), f0 == lobe_dielectric_f0 ? 0.15 : 3.1);
                // The horizon cuts the widest ones, and mixtures leave out how far the two lie from each other.
                EXPECT_NEAR(cone.one_minus_cos / lobe.one_minus_cos(), 1.0, roughness < 0.7f ? 0.25 : 0.43);
            }
    // From low a rough dielectric's mean reflection lies this far from a metal's.
    const vec3 low = direction(0.1f);
    EXPECT_GT(degrees_between(specular_cone(low, 0.64f, 0.04f, ggx_albedo_split(0.1f, 0.64f)).direction, specular_cone(low, 0.64f).direction), 15);
}

TEST(SpecularCone, InPartsIsTheLobe) {
    const auto radiance = [](vec3 d) { return std::exp(-4.0 * (1 - dot(d, normalize(vec3(-0.7f, 0.3f, 0.3f))))); };
    for (float f0 : {0.04f, 0.5f})
        for (float mu : {0.8f, 0.2f})
            for (float alpha : {0.1f, 0.5f, 1.0f}) {
                const vec3 wo = direction(mu, 0.4f);
                const vec2 split = ggx_albedo_split(mu, alpha);
                const vec3 albedo = vec3(f0) * split.x + vec3(split.y);
                double exact = 0, energy = 0, parts = 0, weights = 0;
                visit_lobe(wo, alpha, 0, [&](vec3 wi, double share, double) {
                    const double counted = share * fresnel_schlick(vec3(f0), 1, dot(wo, normalize(wo + wi))).x;
                    energy += counted;
                    exact += counted * radiance(wi);
                });
                constexpr std::uint32_t samples = 4096;
                for (std::uint32_t i = 0; i < samples; ++i) {
                    vec3 weight;
                    const Cone cone = reflection_cone(wo, alpha, albedo, vec2(tests::cube_point(i)), 1.0f / samples, weight);
                    EXPECT_GE(cone.one_minus_cos, 0.0f);
                    EXPECT_LE(cone.one_minus_cos, 1.0f);
                    parts += weight.x * radiance(cone.direction) / samples;
                    weights += weight.x / samples;
                }
                SCOPED_TRACE(::testing::Message() << "F0 " << f0 << " mu " << mu << " alpha " << alpha);
                EXPECT_NEAR(weights, 1, 0.01);
                EXPECT_NEAR(parts / (exact / energy), 1, 0.01);
            }
}

TEST(SpecularCone, StandsInATableThatIsWithinATenthOfSolidAngleAtGrazingIncidence) {
    for (float alpha : {0.0017f, 0.01f, 0.12f})
        for (float mu : {0.003f, 0.02f, 0.06f}) {
            const vec2 entry = specular_lobe(mu, alpha, 0);
            const SampledLobe lobe = sampled_lobe(direction(mu), alpha, 0);
            SCOPED_TRACE(::testing::Message() << "alpha " << alpha << " mu " << mu);
            EXPECT_NEAR(entry.y * entry.y * alpha * alpha / lobe.one_minus_cos(), 1.0, 0.1);
            EXPECT_NEAR(entry.x * std::acos(mu), std::atan2(-lobe.mean.x, lobe.mean.z), 0.2 * turn / 360);
        }
}

TEST(SpecularCone, OfANarrowLobeHasTheSolidAngleOfItsMeanSquareExactly) {
    // Near the normal D = 1/(π α² (1 + t²)²) with t = tan θh/α, so ∫ D² dω = 1/(3π α²), and reflecting spreads
    // half vectors over 4 cos θ times their solid angle: 1 − cos = 3π α² · 4 cos θ/(2π).
    for (float alpha : {0.0025f, 0.01f})
        for (float mu : {1.0f, 0.7f, 0.4f})
            EXPECT_NEAR(specular_cone(direction(mu, 2.0f), alpha).one_minus_cos / (6 * alpha * alpha * mu), 1.0f,
                        5e-3f);
}

TEST(SpecularCone, OfANarrowLobeHoldsThreeQuartersOfItsLight) {
    // Within t the lobe has t²/(1 + t²), and the cone's rim is at t² = 3.
    const vec3 wo = direction(1.0f);
    const Cone cone = specular_cone(wo, 0.01f);
    double inside = 0;
    visit_lobe(wo, 0.01f, 0, [&](vec3 wi, double share, double) {
        if (std::hypot(wi.x, wi.y) <= wi.z * cone.tan_half_angle) inside += share;
    });
    EXPECT_NEAR(inside, 0.75, 0.005);
}

TEST(SpecularCone, NeverDipsBelowTheHorizon) {
    for (int i = 1; i <= 20; ++i)
        for (int k = 0; k <= 30; ++k) {
            const Cone cone = specular_cone(direction(std::max(k / 30.0f, 1e-3f), 1.0f), ggx_alpha(i / 20.0f));
            ASSERT_TRUE(std::isfinite(cone.tan_half_angle));
            ASSERT_NEAR(length(cone.direction), 1.0f, 1e-5f);
            EXPECT_GT(cone.direction.z, 0.0f);
            EXPECT_GE(cone.one_minus_cos, 0.0f);
            // sin of the elevation ≥ sin of the half-angle
            const double cosine = 1 - double(cone.one_minus_cos);
            EXPECT_GE(cone.direction.z, std::sqrt(1 - cosine * cosine) - 1e-3);
        }
}

TEST(SpecularCone, OfTheRoughestSurfaceLooksAlongTheNormal) {
    // At α = 1 the lobe is μi/(μo + μi), even about the normal (Lommel and Seeliger's law).
    for (float mu : {1.0f, 0.5f, 0.1f}) {
        EXPECT_NEAR(specular_cone(direction(mu), 1.0f).direction.z, 1.0f, 1e-5f);
    }
    // Seen from above its mean density is known: ∫ (μ/(1 + μ))² dμ/(1 − ln 2)² = (3/2 − 2 ln 2)/(1 − ln 2)².
    const double log2 = std::numbers::ln2, exact = (1 - log2) * (1 - log2) / (1.5 - 2 * log2);
    EXPECT_NEAR(specular_cone(direction(1.0f), 1.0f).one_minus_cos / exact, 1.0, 1e-3);
}

TEST(RefractionCone, OfASmoothSurfaceFollowsSnell) {
    for (float eta : {1.5f, 3.0f, 1 / 1.5f})
        for (float mu : {1.0f, 0.9f, 0.8f}) {
            Cone cone;
            ASSERT_TRUE(refraction_cone(direction(mu), ggx_smallest_alpha, eta, cone));
            EXPECT_NEAR(cone.direction.x, -std::sqrt(1 - mu * mu) / eta, 2e-4) << eta << ' ' << mu;
            EXPECT_LT(cone.direction.z, 0.0f);
            EXPECT_NEAR(cone.weight, 1.0f, 1e-5f);
        }
}

TEST(RefractionCone, OfANarrowLobeIsScaledByTheHalfVectorsJacobian) {
    // Walter et al. 2007, eq. 17 at h = n: dω_i/dω_h = (η cos θi − cos θo)²/(η² cos θi); ∫ D² as for reflection.
    for (float eta : {1.5f, 3.0f, 1 / 1.5f})
        for (float mu : {1.0f, 0.9f}) {
            const float alpha = 0.01f;
            Cone cone;
            ASSERT_TRUE(refraction_cone(direction(mu), alpha, eta, cone));
            const double cos_i = std::sqrt(1 - (1 - mu * mu) / (eta * eta));
            const double jacobian = std::pow(eta * cos_i - mu, 2) / (eta * eta * cos_i);
            EXPECT_NEAR(cone.one_minus_cos / (1.5 * alpha * alpha * jacobian), 1.0, 0.01) << eta << ' ' << mu;
        }
}

TEST(RefractionCone, PointsWhereTheRefractionsOfGgxDoOnAverage) {
    for (float eta : {1.5f, 3.0f})
        for (float roughness : {0.1f, 0.3f, 0.5f, 0.8f, 1.0f})
            for (float mu : {1.0f, 0.7f, 0.4f}) {
                const vec3 wo = direction(mu, 0.7f);
                const float alpha = ggx_alpha(roughness);
                Cone cone;
                ASSERT_TRUE(refraction_cone(wo, alpha, eta, cone));
                const SampledLobe lobe = sampled_lobe(wo, alpha, eta);
                SCOPED_TRACE(::testing::Message() << "eta " << eta << " roughness " << roughness << " mu " << mu);
                EXPECT_LE(degrees_between(cone.direction, lobe.mean), 0.5);
                EXPECT_NEAR(1 - 0.5 * cone.one_minus_cos, lobe.mean_cosine(), 0.025);
                EXPECT_NEAR(cone.one_minus_cos / lobe.one_minus_cos(), 1.0, 0.02);
            }
}

TEST(RefractionCone, IsAbsentUnderTotalReflectionAndPartialNearIt) {
    Cone cone;
    EXPECT_FALSE(refraction_cone(direction(0.5f), 0.01f, 1 / 1.5f, cone));  // critical cosine: 0.745
    ASSERT_TRUE(refraction_cone(direction(0.7f), 0.16f, 1 / 1.5f, cone));
    EXPECT_GT(cone.weight, 0.2f);
    EXPECT_LT(cone.weight, 0.5f);
    EXPECT_LT(cone.direction.z, 0.0f);
}

TEST(LightCone, HasTheHalfAngleUnderWhichTheLightAppears) {
    LightData light{};
    light.type = light_type_point;
    light.position = vec3(0, 2, 0);
    EXPECT_EQ(light_cone_tan(light, vec3(0)), 0.0f);
    light.radius = 0.5f;
    EXPECT_NEAR(light_cone_tan(light, vec3(0)), 0.5 / std::sqrt(4 - 0.25), 1e-6);
    EXPECT_EQ(light_cone_tan(light, vec3(0, 1.8f, 0)), 0.0f);
    light.type = light_type_directional;
    light.radius = 0.00465f;
    EXPECT_NEAR(light_cone_tan(light, vec3(0)) / std::tan(0.00465), 1.0, 1e-5);
}

}  // namespace
}  // namespace heliodon::shading
