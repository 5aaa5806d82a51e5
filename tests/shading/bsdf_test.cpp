#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "extended_surfaces.h"
#include "shading/bsdf.h"
#include "shading/random.h"

namespace heliodon::shading {
namespace {

using tests::direction;
using tests::glass_surface;
using tests::returned_energy;
using tests::standard_surface;

constexpr float roughnesses[] = {0.0f, 0.05f, 0.1f, 0.2f, 0.3f, 0.45f, 0.6f, 0.75f, 0.9f, 1.0f};
constexpr float cosines[] = {0.05f, 0.2f, 0.4f, 0.7f, 1.0f};

TEST(Bsdf, WhiteFurnaceReturnsOneForEveryRoughnessAndMetalness) {
    for (float roughness : roughnesses) {
        for (float metallic : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
            for (float mu : cosines) {
                const Surface surface = standard_surface(vec3(1), metallic, roughness);
                const double energy = returned_energy(surface, direction(mu), 8192).y;
                EXPECT_NEAR(energy, 1.0, 0.005)
                    << "roughness " << roughness << " metallic " << metallic << " mu " << mu;
            }
        }
    }
}

TEST(Bsdf, WhiteFurnaceReturnsOneForEveryIndex) {
    for (float ior : {1.0f, 1.33f, 1.8f, 2.42f}) {
        for (float roughness : {0.0f, 0.3f, 1.0f}) {
            Surface surface = standard_surface(vec3(1), 0, roughness);
            surface.ior = ior;
            EXPECT_NEAR(returned_energy(surface, direction(0.5f), 8192).y, 1.0, 0.005) << ior << ' ' << roughness;
        }
    }
}

TEST(Bsdf, AlbedosOfAWhiteSurfaceAddUpToExactlyOne) {
    for (float roughness : roughnesses) {
        for (float metallic : {0.0f, 0.5f, 1.0f}) {
            for (float mu : cosines) {
                const Surface surface = standard_surface(vec3(1), metallic, roughness);
                EXPECT_NEAR(bsdf_albedo(surface, direction(mu)).y, 1.0f, 1e-5f)
                    << roughness << ' ' << metallic << ' ' << mu;
            }
        }
    }
}

TEST(Bsdf, AlbedosAreTheIntegralsOfTheLobes) {
    for (float roughness : {0.1f, 0.5f, 1.0f}) {
        for (float metallic : {0.0f, 0.6f, 1.0f}) {
            for (float mu : {0.2f, 0.8f}) {
                const Surface surface = standard_surface(vec3(0.9f, 0.5f, 0.1f), metallic, roughness);
                const glm::dvec3 energy = returned_energy(surface, direction(mu), 1 << 15);
                const vec3 table = bsdf_albedo(surface, direction(mu));
                for (int c = 0; c < 3; ++c) {
                    EXPECT_NEAR(table[c], energy[c], 0.003) << roughness << ' ' << metallic << ' ' << mu << ' ' << c;
                }
            }
        }
    }
}

TEST(Bsdf, LambertOfOneHalfReturnsExactlyHalf) {
    Surface surface = standard_surface(vec3(0.5f), 0, 1);
    surface.model = material_model_lambert;
    for (float mu : cosines) {
        EXPECT_EQ(bsdf_albedo(surface, direction(mu)), vec3(0.5f));
        for (std::uint32_t i = 0; i < 100; ++i) {
            EXPECT_NEAR(bsdf_sample(surface, direction(mu), tests::cube_point(i)).weight.x, 0.5f, 1e-6f);
        }
        EXPECT_FLOAT_EQ(bsdf_evaluate(surface, direction(mu), direction(0.3f, 2)).x, 0.5f * inverse_pi * 0.3f);
        EXPECT_EQ(bsdf_evaluate(surface, direction(mu), -direction(0.3f)), vec3(0));
    }
}

TEST(Bsdf, UnlitTakesNoLight) {
    Surface surface = surface_default();
    surface.model = material_model_unlit;
    EXPECT_EQ(bsdf_evaluate(surface, direction(0.5f), direction(0.5f)), vec3(0));
    EXPECT_EQ(bsdf_sample(surface, direction(0.5f), vec3(0.5f)).pdf, 0.0f);
    EXPECT_EQ(bsdf_albedo(surface, direction(0.5f)), vec3(0));
}

TEST(Bsdf, NothingIsSeenFromBelowTheShadingNormal) {
    const Surface surface = surface_default();
    EXPECT_EQ(bsdf_evaluate(surface, -direction(0.5f), direction(0.5f)), vec3(0));
    EXPECT_EQ(bsdf_pdf(surface, -direction(0.5f), direction(0.5f)), 0.0f);
}

Surface random_surface(std::uint32_t i) {
    const vec4 a = random4(i, 0, 0, 7), b = random4(i, 1, 0, 7), c = random4(i, 2, 0, 7);
    Surface surface = standard_surface(vec3(a), i % 3 == 0 ? 0.0f : a.w, 0.08f + 0.92f * b.x);
    surface.ior = 1.0f + 1.5f * b.y;
    surface.transmission = i % 2 == 0 ? 0.0f : b.z;
    surface.specular = i % 5 == 0 ? b.w : 1.0f;
    surface.clearcoat = i % 4 == 0 ? c.x : 0.0f;
    surface.clearcoat_roughness = 0.1f + 0.9f * c.y;
    return surface;
}

TEST(Bsdf, ReflectionIsReciprocal) {
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const Surface surface = random_surface(i);
        const vec4 u = random4(i, 3, 0, 7);
        const vec3 a = direction(0.05f + 0.95f * u.x, 6 * u.y), b = direction(0.05f + 0.95f * u.z, 6 * u.w);
        const vec3 there = bsdf_evaluate(surface, a, b) / b.z, back = bsdf_evaluate(surface, b, a) / a.z;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], 2e-4f * (1e-3f + there[c])) << i;
    }
}

TEST(Bsdf, RefractionIsReciprocalForBasicRadiance) {
    // Radiance over the square of the index is what reverses: Veach 1997, eq. 5.14.
    for (std::uint32_t i = 0; i < 500; ++i) {
        const vec4 u = random4(i, 4, 0, 7);
        const Surface outside = glass_surface(0.2f + 0.8f * u.x, 1.1f + u.y, false);
        Surface inside = outside;
        inside.inside = true;
        const vec3 wo = direction(0.1f + 0.9f * u.z, 1), wi = -direction(0.1f + 0.9f * u.w, 1.4f);
        const float there = bsdf_evaluate(outside, wo, wi).x / -wi.z * outside.ior * outside.ior;
        const float back = bsdf_evaluate(inside, -wi, -wo).x / wo.z;
        EXPECT_NEAR(there, back, 1e-3f * (1e-3f + there)) << i;
    }
}

TEST(Bsdf, NoSurfaceReturnsMoreLightThanItReceives) {
    for (std::uint32_t i = 0; i < 300; ++i) {
        Surface surface = random_surface(i);
        surface.base_color = i % 2 == 0 ? vec3(1) : surface.base_color;
        const float mu = 0.03f + 0.97f * random1(i, 5, 0, 7);
        const glm::dvec3 energy = returned_energy(surface, direction(mu), 8192);
        for (int c = 0; c < 3; ++c)
            EXPECT_LE(energy[c], 1.006) << i << " mu " << mu << " roughness " << surface.roughness;
        surface.inside = surface.transmission > 0 && surface.metallic < 1;
        if (surface.inside) EXPECT_LE(returned_energy(surface, direction(mu), 8192).y, 1.006) << i << " inside";
    }
}

TEST(Bsdf, ClearGlassPassesOrReflectsAllLightFromBothSides) {
    for (float ior : {1.2f, 1.5f, 2.2f}) {
        for (float roughness : {0.0f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f}) {
            for (float mu : {0.1f, 0.3f, 0.6f, 1.0f}) {
                for (bool inside : {false, true}) {
                    const double energy =
                        returned_energy(glass_surface(roughness, ior, inside), direction(mu), 1 << 14).y;
                    EXPECT_NEAR(energy, 1.0, 0.0075)
                        << "ior " << ior << " roughness " << roughness << " mu " << mu << (inside ? " inside" : "");
                }
            }
        }
    }
}

TEST(Bsdf, ClearCoatLosesNoMoreThanAFewPerCent) {
    for (float roughness : {0.1f, 0.5f, 1.0f}) {
        for (float metallic : {0.0f, 1.0f}) {
            for (float mu : {0.2f, 0.6f, 1.0f}) {
                Surface surface = standard_surface(vec3(1), metallic, roughness);
                surface.clearcoat = 1;
                surface.clearcoat_roughness = 0.1f;
                const double energy = returned_energy(surface, direction(mu), 1 << 14).y;
                EXPECT_LE(energy, 1.003);
                EXPECT_GE(energy, 0.95);
                EXPECT_NEAR(bsdf_albedo(surface, direction(mu)).y, energy, 0.05)
                    << roughness << ' ' << metallic << ' ' << mu;
            }
        }
    }
}

/// Upper tail of χ² with `freedom` degrees: Wilson & Hilferty 1931.
double chi_square_p(double statistic, double freedom) {
    const double z = (std::cbrt(statistic / freedom) - (1 - 2 / (9 * freedom))) / std::sqrt(2 / (9 * freedom));
    return 0.5 * std::erfc(z / std::sqrt(2.0));
}

struct SamplerCase {
    const char* name;
    Surface surface;
};
std::vector<SamplerCase> sampler_cases() {
    std::vector<SamplerCase> cases = {{"dielectric", standard_surface(vec3(0.8f), 0, 0.5f)},
                                      {"rough dielectric", standard_surface(vec3(0.3f), 0, 1.0f)},
                                      {"metal", standard_surface(vec3(0.9f, 0.6f, 0.4f), 1, 0.6f)},
                                      {"mixture", standard_surface(vec3(0.5f), 0.5f, 0.7f)},
                                      {"glass", glass_surface(0.7f, 1.5f, false)},
                                      {"glass from within", glass_surface(0.7f, 1.5f, true)},
                                      {"rough glass", glass_surface(1.0f, 1.3f, false)},
                                      {"coat", standard_surface(vec3(0.5f), 0, 0.8f)},
                                      {"lambert", standard_surface(vec3(0.5f), 0, 0.8f)}};
    cases[7].surface.clearcoat = 1;
    cases[7].surface.clearcoat_roughness = 0.5f;
    cases[8].surface.model = material_model_lambert;
    for (const tests::NamedSurface& extended : tests::extended_surfaces()) cases.push_back({extended.name, extended.surface});
    return cases;
}

constexpr int rings = 20, sectors = 20;
int cell_of(vec3 w) {
    const int ring = std::min(static_cast<int>((w.z + 1) * 0.5f * rings), rings - 1);
    const float turn = std::atan2(w.y, w.x) / (2 * pi) + 0.5f;
    return ring * sectors + std::min(static_cast<int>(turn * sectors), sectors - 1);
}
std::vector<double> expected_shares(const Surface& surface, vec3 wo) {
    constexpr int steps = 16;
    const BsdfLobes lobes = bsdf_prepare(surface, wo);
    std::vector<double> shares(rings * sectors);
    const double cell = 4 * double(pi) / (rings * sectors * steps * steps);
    for (int i = 0; i < rings * steps; ++i) {
        for (int k = 0; k < sectors * steps; ++k) {
            const float z = -1 + 2 * (i + 0.5f) / (rings * steps), turn = (k + 0.5f) / (sectors * steps);
            const vec3 w = direction(z, 2 * pi * (turn - 0.5f));
            shares[(i / steps) * sectors + k / steps] += bsdf_pdf_prepared(surface, lobes, wo, w) * cell;
        }
    }
    return shares;
}

TEST(Bsdf, SamplesFollowTheirDensityByChiSquare) {
    constexpr std::uint32_t samples = 100000;
    for (const SamplerCase& test : sampler_cases()) {
        for (float mu : {0.3f, 0.9f}) {
            const vec3 wo = direction(mu, 0.7f);
            const std::vector<double> shares = expected_shares(test.surface, wo);
            std::vector<double> counts(shares.size());
            double found = 0;
            for (std::uint32_t i = 0; i < samples; ++i) {
                const BsdfSample sample = bsdf_sample(test.surface, wo, random3(i, 0, 0, 11));
                if (sample.pdf <= 0) continue;
                counts[cell_of(sample.direction)] += 1;
                found += 1;
            }
            double total = 0;
            for (double share : shares) total += share;
            // What falls below the horizon is missing from both alike.
            EXPECT_NEAR(total, found / samples, 0.005) << test.name << ' ' << mu;

            double statistic = 0, pooled_expected = 0, pooled_count = 0;
            int cells = 0;
            for (std::size_t c = 0; c < shares.size(); ++c) {
                const double expected = shares[c] * samples;
                if (expected < 10) {
                    pooled_expected += expected;
                    pooled_count += counts[c];
                    continue;
                }
                statistic += (counts[c] - expected) * (counts[c] - expected) / expected;
                ++cells;
            }
            if (pooled_expected > 10) {
                statistic += (pooled_count - pooled_expected) * (pooled_count - pooled_expected) / pooled_expected;
                ++cells;
            }
            EXPECT_GT(chi_square_p(statistic, cells - 1), 1e-4)
                << test.name << ' ' << mu << " χ² " << statistic << " / " << cells;
        }
    }
}

TEST(Bsdf, SampleWeightsAreValueOverDensity) {
    for (const SamplerCase& test : sampler_cases()) {
        const vec3 wo = direction(0.6f);
        for (std::uint32_t i = 0; i < 300; ++i) {
            const BsdfSample sample = bsdf_sample(test.surface, wo, tests::cube_point(i));
            if (sample.pdf <= 0) continue;
            EXPECT_NEAR(length(sample.direction), 1.0f, 1e-5f);
            EXPECT_EQ(sample.transmitted, sample.direction.z < 0) << test.name;
            const vec3 value = bsdf_evaluate(test.surface, wo, sample.direction);
            EXPECT_NEAR(bsdf_pdf(test.surface, wo, sample.direction), sample.pdf, 1e-5f * sample.pdf);
            EXPECT_NEAR(value.x, sample.weight.x * sample.pdf, 1e-4f * (value.x + 1e-4f)) << test.name;
        }
    }
}

bool finite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

TEST(Bsdf, StaysFiniteForExtremeMaterialsAndGrazingViews) {
    const float edges[] = {0.0f, 1e-4f, 0.5f, 1.0f};
    for (std::uint32_t i = 0; i < 4 * 4 * 4 * 4 * 4; ++i) {
        Surface surface = standard_surface(vec3(i % 2 == 0 ? 1.0f : 0.0f), edges[i % 4], edges[i / 4 % 4]);
        surface.transmission = edges[i / 16 % 4];
        surface.clearcoat = edges[i / 64 % 4];
        const float iors[] = {0.0f, 1.0f, 1.0005f, 3.0f};
        surface.ior = iors[i / 256 % 4];
        surface.inside = i % 3 == 0;
        for (float mu : {1e-7f, 1e-3f, 0.7f, 1.0f}) {
            const vec3 wo = direction(mu, 0.3f);
            ASSERT_TRUE(finite(bsdf_albedo(surface, wo))) << i << ' ' << mu;
            for (std::uint32_t k = 0; k < 12; ++k) {
                const vec3 u = k == 0 ? vec3(0) : k == 1 ? vec3(0.99999994f) : tests::cube_point(k);
                const BsdfSample sample = bsdf_sample(surface, wo, u);
                ASSERT_TRUE(finite(sample.weight) && std::isfinite(sample.pdf) && sample.pdf >= 0)
                    << i << ' ' << mu << ' ' << k;
                const vec3 wi = k % 3 == 0 ? vec3(-wo.x, -wo.y, wo.z) : k % 3 == 1 ? -wo : direction(1e-7f, 2.0f);
                ASSERT_TRUE(finite(bsdf_evaluate(surface, wo, wi))) << i << ' ' << mu << ' ' << k;
                ASSERT_TRUE(std::isfinite(bsdf_pdf(surface, wo, wi))) << i << ' ' << mu << ' ' << k;
            }
        }
    }
}

TEST(Bsdf, SmoothDielectricReflectsAsFresnelsF0Says) {
    Surface surface = standard_surface(vec3(0), 0, 0.0f);
    surface.ior = 1.52f;
    EXPECT_NEAR(bsdf_albedo(surface, vec3(0, 0, 1)).x, 0.042580f, 2e-5f);
    EXPECT_NEAR(returned_energy(surface, vec3(0, 0, 1), 4096).x, 0.042580, 2e-4);
}

TEST(Bsdf, TintedGlassColoursEachCrossingByTheRoot) {
    Surface surface = glass_surface(0.0f, 1.5f, false);
    surface.base_color = vec3(0.25f, 1, 1);
    const glm::dvec3 energy = returned_energy(surface, vec3(0, 0, 1), 1 << 14);
    EXPECT_NEAR(energy.x, 0.04 + 0.5 * 0.96, 0.003);
    EXPECT_NEAR(energy.y, 1.0, 0.003);
}

}  // namespace
}  // namespace heliodon::shading
