#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "quadrature_points.h"
#include "shading/ggx_albedo.h"

namespace heliodon::shading {
namespace {

using tests::direction;

float albedo(float mu, float alpha) {
    const vec2 split = ggx_albedo_split(mu, alpha);
    return split.x + split.y;
}
float albedo_average(float alpha) {
    const vec2 split = ggx_albedo_split_average(alpha);
    return split.x + split.y;
}

struct AlbedoTruth {
    float alpha, average, at[5];  // at μ = .1 .3 .5 .7 1
};
// External truth, "Materials": Gauss-Legendre quadrature of GGX with height-correlated Smith at F = 1.
constexpr AlbedoTruth truths[] = {
    {0.1f, 0.972046f, {0.883517f, 0.936254f, 0.969202f, 0.981420f, 0.988324f}},
    {0.5f, 0.700241f, {0.860106f, 0.745271f, 0.698251f, 0.682954f, 0.687854f}},
    {1.0f, 0.409137f, {0.760208f, 0.560099f, 0.450694f, 0.378888f, 0.306855f}},
};

TEST(Ggx, DirectionalAlbedoMatchesExactQuadratureToATenthOfAPerCent) {
    constexpr float cosines[] = {0.1f, 0.3f, 0.5f, 0.7f, 1.0f};
    for (const AlbedoTruth& truth : truths) {
        EXPECT_NEAR(albedo_average(truth.alpha) / truth.average, 1.0f, 1e-3f) << truth.alpha;
        for (int i = 0; i < 5; ++i) {
            EXPECT_NEAR(albedo(cosines[i], truth.alpha) / truth.at[i], 1.0f, 1e-3f) << truth.alpha << ' ' << cosines[i];
        }
    }
}

TEST(Ggx, RoughestAlbedoAtNormalIncidenceIsOneMinusLogTwo) {
    EXPECT_NEAR(albedo(1.0f, 1.0f), 1 - std::numbers::ln2, 1e-5);
}

/// E by brute force: 500² midpoints over the visible normals.
double converged_albedo(float mu, float alpha) {
    const vec3 wo = direction(mu);
    constexpr int points = 500;
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        for (int k = 0; k < points; ++k) {
            const double height = (k + 0.5) / points;
            const vec2 u((i + 0.5f) / points, static_cast<float>(1 - height * height * height));
            const vec3 h = ggx_sample_visible_normal(wo, alpha, u);
            const vec3 wi = 2.0f * dot(wo, h) * h - wo;
            if (wi.z > 0) sum += 3 * height * height * ggx_g2(mu, wi.z, alpha) / ggx_g1(mu, alpha);
        }
    }
    return sum / (points * double(points));
}

TEST(Ggx, TableInterpolatesBetweenItsEntries) {
    for (float roughness : {0.12f, 0.21f, 0.35f, 0.52f, 0.87f}) {
        const float alpha = ggx_alpha(roughness);
        for (float mu : {0.13f, 0.37f, 0.83f}) {
            EXPECT_NEAR(albedo(mu, alpha) / converged_albedo(mu, alpha), 1.0, 5e-4) << roughness << ' ' << mu;
        }
        EXPECT_NEAR(albedo(0.02f, alpha) / converged_albedo(0.02f, alpha), 1.0, 2.5e-3) << roughness;
    }
}

TEST(Ggx, ProjectedDistributionIntegratesToOne) {
    for (float alpha : {1e-3f, 0.1f, 0.5f, 1.0f}) {
        // ∫ D cos θ dω with tan θ = α x/(1 − x): the mass spreads evenly.
        double sum = 0;
        constexpr int points = 4000;
        for (int i = 0; i < points; ++i) {
            const double x = (i + 0.5) / points, tangent = alpha * x / (1 - x);
            const double cosine = 1 / std::sqrt(1 + tangent * tangent), slope = alpha / ((1 - x) * (1 - x));
            const double sine = tangent * cosine;
            const vec3 h(static_cast<float>(sine), 0.0f, static_cast<float>(cosine));
            sum += ggx_distribution(h, alpha) * cosine * sine * 2 * std::numbers::pi * slope * cosine * cosine / points;
        }
        EXPECT_NEAR(sum, 1.0, 1e-3) << alpha;
    }
}

TEST(Ggx, VisibleNormalsProjectToTheViewersCosine) {
    // ∫ G1 D max(o·h, 0) dω = cos θo (Heitz 2014, eq. 19): the density of visible normals integrates to 1.
    for (float alpha : {0.2f, 0.6f, 1.0f}) {
        for (float mu : {0.1f, 0.5f, 1.0f}) {
            const vec3 wo = direction(mu);
            double sum = 0;
            constexpr int rings = 400, sectors = 400;
            for (int i = 0; i < rings; ++i) {
                for (int k = 0; k < sectors; ++k) {
                    const vec3 h = direction((i + 0.5f) / rings, 2 * pi * (k + 0.5f) / sectors);
                    sum += ggx_visible_normal_pdf(wo, h, alpha);
                }
            }
            EXPECT_NEAR(sum * 2 * std::numbers::pi / (rings * sectors), 1.0, 2e-3) << alpha << ' ' << mu;
        }
    }
}

TEST(Ggx, SampledNormalsFollowTheirDensity) {
    // Mean of a test function over samples against its integral over the density.
    for (float alpha : {0.3f, 0.8f}) {
        const vec3 wo = direction(0.4f);
        const auto test = [](vec3 h) { return glm::dvec3(h.x, h.y * h.y, h.z * h.z * h.x); };
        glm::dvec3 sampled(0), integrated(0);
        constexpr std::uint32_t samples = 1 << 17;
        for (std::uint32_t i = 0; i < samples; ++i) {
            sampled += test(ggx_sample_visible_normal(wo, alpha, vec2(tests::cube_point(i)))) / double(samples);
        }
        constexpr int points = 600;
        for (int i = 0; i < points; ++i) {
            for (int k = 0; k < points; ++k) {
                const vec3 h = direction((i + 0.5f) / points, 2 * pi * (k + 0.5f) / points);
                integrated +=
                    test(h) * (ggx_visible_normal_pdf(wo, h, alpha) * 2 * std::numbers::pi / (points * points));
            }
        }
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sampled[c], integrated[c], 1e-3) << alpha << ' ' << c;
    }
}

TEST(Ggx, RefractionObeysSnell) {
    for (float eta : {1.5f, 1 / 1.5f}) {
        const vec3 wo = direction(0.8f), h = normalize(vec3(0.1f, -0.05f, 1.0f));
        vec3 wi;
        ASSERT_TRUE(refract_about(wo, h, eta, wi));
        EXPECT_NEAR(length(wi), 1.0f, 1e-6);
        EXPECT_NEAR(length(cross(wo, h)), eta * length(cross(wi, h)), 1e-6);
        const vec3 found = refraction_half_vector(wo, wi, eta);
        EXPECT_NEAR(dot(found, h), 1.0f, 1e-6);
    }
}

}  // namespace
}  // namespace heliodon::shading
