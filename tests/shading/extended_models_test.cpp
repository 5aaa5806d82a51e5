#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "extended_surfaces.h"
#include "shading/metals.h"
#include "shading/random.h"

namespace heliodon::shading {
namespace {

using namespace tests;

constexpr float cosines[] = {0.1f, 0.3f, 0.6f, 1.0f};

vec3 at_degrees(float polar, float azimuth) {
    return direction(std::cos(polar * pi / 180), azimuth * pi / 180);
}
vec3 linear(vec3 monitor) {  // BRDF Explorer's mon2lin
    return glm::pow(monitor, vec3(2.2f));
}

// -- Disney 2012: values of BRDF Explorer's disney.brdf with its defaults

TEST(Disney, ADefaultSurfaceReflectsAsBrdfExplorerSays) {
    const Surface surface = disney_surface(linear({0.82f, 0.67f, 0.16f}), 0, 0.5f);
    const vec3 wi = at_degrees(60, 0), wo = at_degrees(20, 120);
    const vec3 f = bsdf_evaluate(surface, wo, wi) / wi.z;
    EXPECT_NEAR(f.x, 0.2125309f, 2e-6f);
    EXPECT_NEAR(f.y, 0.1383477f, 2e-6f);
    EXPECT_NEAR(f.z, 0.0114704f, 2e-6f);
}

TEST(Disney, AGlossyMetalReflectsAsBrdfExplorerSays) {
    const Surface surface = disney_surface(linear({0.82f, 0.67f, 0.16f}), 1, 0.3f);
    const vec3 wi = at_degrees(30, 0), wo = at_degrees(30, 180);
    const vec3 f = bsdf_evaluate(surface, wo, wi) / wi.z;
    EXPECT_NEAR(f.x, 8.4539346f, 2e-5f);
    EXPECT_NEAR(f.y, 5.4206231f, 2e-5f);
    EXPECT_NEAR(f.z, 0.2326797f, 2e-5f);
}

TEST(Disney, TheCoatAddsAQuarterOfItsLobe) {
    Surface surface = disney_surface(vec3(0.5f), 0, 0.5f);
    const vec3 w = at_degrees(0, 0);
    const float without = bsdf_evaluate(surface, w, w).x;
    surface.clearcoat = 1;
    surface.clearcoat_gloss = 0;
    // At normal incidence G = (2/(1 + 1))² / 4 = 1/4, F = 0.04, and D of exponent 1 is (α² − 1)/(π ln α² · α²) with α = 0.1.
    const double distribution = (0.01 - 1) / (3.14159265358979 * std::log(0.01) * 0.01);
    EXPECT_NEAR(bsdf_evaluate(surface, w, w).x - without, 0.25 * 0.04 * 0.25 * distribution, 2e-5);
}

// -- conductors

TEST(Metals, NormalReflectanceIsThatOfTheMeasuredSpectra) {
    const struct {
        Metal metal;
        glm::dvec3 f0;
    } published[] = {{Metal::gold, {1.0219, 0.7825, 0.3434}},
                     {Metal::copper, {0.9553, 0.6376, 0.5382}},
                     {Metal::aluminium, {0.9132, 0.9215, 0.9244}},
                     {Metal::silver, {0.9715, 0.9599, 0.9153}}};
    for (const auto& [metal, f0] : published)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(metal_reflectance(metal, 1)[c], f0[c], 1.5e-4) << int(metal) << ' ' << c;
}

TEST(Metals, OneIndexAChannelStandsForTheSpectrumAtEveryAngle) {
    for (const Metal metal : {Metal::gold, Metal::silver, Metal::copper, Metal::aluminium, Metal::iron, Metal::chromium}) {
        const ConductorIndices indices = metal_indices(metal);
        for (const double mu : {1.0, 0.8, 0.5, 0.3, 0.1428, 0.05}) {
            const glm::dvec3 spectral = glm::min(metal_reflectance(metal, mu), glm::dvec3(1));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(fresnel_conductor(static_cast<float>(mu), indices.eta[c], indices.k[c]), spectral[c], mu == 1 ? 2e-4 : 0.015)
                    << int(metal) << ' ' << mu << ' ' << c;
        }
    }
}

TEST(Conductors, SmoothOnesReflectFresnelsTerm) {
    const vec3 eta(0.2f, 1.1f, 2.9f), k(3.9f, 2.5f, 3.1f);
    for (float mu : {0.2f, 0.6f, 1.0f}) {
        const Surface surface = conductor_surface(eta, k, 0);
        const glm::dvec3 energy = returned_energy(surface, direction(mu), 4096);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(energy[c], fresnel_conductor(mu, eta[c], k[c]), 1e-3) << mu << ' ' << c;
    }
}

TEST(Conductors, APerfectOneReturnsAllLightAtEveryRoughness) {
    for (float roughness : {0.1f, 0.4f, 0.7f, 1.0f})
        for (float mu : cosines) {
            const Surface surface = conductor_surface(vec3(1e-4f), vec3(10), roughness);
            EXPECT_NEAR(returned_energy(surface, direction(mu), 8192).y, 1, 0.005) << roughness << ' ' << mu;
        }
}

// -- rough diffuse

TEST(RoughDiffuse, AWhiteOneReturnsAllLightByRoughness) {
    for (float roughness : {0.0f, 0.3f, 0.7f, 1.0f})
        for (float mu : cosines) {
            const Surface surface = rough_diffuse_surface(vec3(1), roughness, -1);
            EXPECT_NEAR(returned_energy(surface, direction(mu), 1 << 17).y, 1, 0.002) << roughness << ' ' << mu;
            EXPECT_NEAR(bsdf_albedo(surface, direction(mu)).y, 1, 1e-5f);
        }
}

TEST(RoughDiffuse, AlbedoIsTheIntegral) {
    for (float roughness : {0.2f, 0.6f, 1.0f})
        for (float mu : cosines) {
            const Surface surface = rough_diffuse_surface({0.8f, 0.4f, 0.1f}, roughness, -1);
            const glm::dvec3 energy = returned_energy(surface, direction(mu), 1 << 14);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(bsdf_albedo(surface, direction(mu))[c], energy[c], 0.003);
        }
}

TEST(RoughDiffuse, BySigmaItIsOrenAndNayarsQualitativeModel) {
    const Surface surface = rough_diffuse_surface(vec3(1), 1, glm::radians(20.0f));
    const float s2 = glm::radians(20.0f) * glm::radians(20.0f);
    const float a = 1 - 0.5f * s2 / (s2 + 0.33f), b = 0.45f * s2 / (s2 + 0.09f);
    const vec3 wo = at_degrees(50, 0);
    EXPECT_NEAR(bsdf_evaluate(surface, wo, at_degrees(30, 0)).x,
                (a + b * std::sin(glm::radians(50.0f)) * std::tan(glm::radians(30.0f))) / pi * std::cos(glm::radians(30.0f)), 1e-5f);
    EXPECT_NEAR(bsdf_evaluate(surface, wo, at_degrees(30, 180)).x, a / pi * std::cos(glm::radians(30.0f)), 1e-5f);
}

TEST(RoughDiffuse, OfNoRoughnessItIsLambert) {
    for (const Surface& surface : {rough_diffuse_surface(vec3(0.6f), 0, -1), rough_diffuse_surface(vec3(0.6f), 1, 0)})
        EXPECT_NEAR(bsdf_evaluate(surface, direction(0.3f), direction(0.7f, 2)).x, 0.6f * 0.7f / pi, 1e-6f);
}

// -- anisotropy

/// Directional albedo of the bare lobe by even points of the visible normals.
double stretched_energy(vec3 wo, vec2 alpha, int side) {
    const float seen = 1 + ggx_lambda_stretched(wo, alpha);
    double sum = 0;
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) {
            const vec2 u((static_cast<float>(i) + 0.5f) / static_cast<float>(side), (static_cast<float>(k) + 0.5f) / static_cast<float>(side));
            const vec3 h = ggx_sample_visible_normal_stretched(wo, alpha, u), wi = h * (2 * dot(wo, h)) - wo;
            if (wi.z > 0) sum += seen / (seen + ggx_lambda_stretched(wi, alpha));
        }
    return sum / (side * side);
}

/// Axes as materials have them, and where they are seen from.
struct StretchedCase {
    vec2 alpha;
    vec3 wo;
};
StretchedCase stretched_case(std::uint32_t i) {
    const vec4 u = random4(i, 0, 0, 5);
    const float roughness = 0.05f + 0.95f * u.x, alpha = ggx_alpha(roughness);
    return {{mix(alpha, 1.0f, u.y * u.y), alpha}, direction(i % 4 == 0 ? 0.02f + 0.08f * u.z : 0.1f + 0.9f * u.z, 6.2831853f * u.w)};
}

TEST(Anisotropy, TheTableHoldsTheAlbedoOfStretchedLobes) {
    double squares = 0, worst = 0;
    constexpr std::uint32_t cases = 600;
    for (std::uint32_t i = 0; i < cases; ++i) {
        const auto [alpha, wo] = stretched_case(i);
        for (const bool turned : {false, true}) {
            const vec3 w = turned ? vec3(wo.y, wo.x, wo.z) : wo;
            const vec2 a = turned ? vec2(alpha.y, alpha.x) : alpha;
            const double error = dot(stretched_albedo_split(w, a), vec2(1)) - stretched_energy(w, a, 128);
            squares += error * error / (2 * cases);
            worst = std::max(worst, std::abs(error));
        }
    }
    RecordProperty("rms", std::to_string(std::sqrt(squares)));
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(std::sqrt(squares), 6e-4);
    EXPECT_LT(worst, 4e-3);
}

TEST(Anisotropy, WhatTheLobeAndItsCompensationReturnIsNoMoreThanArrives) {
    double least = 2, most = 0;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const auto [alpha, wo] = stretched_case(i);
        // The compensation's own share of what it is to return: 1 where the averages are those of the table.
        double lost = 0;
        constexpr int rings = 48, sectors = 32;
        for (int ring = 0; ring < rings; ++ring)
            for (int sector = 0; sector < sectors; ++sector) {
                const float mu = (static_cast<float>(ring) + 0.5f) / rings, turn = (static_cast<float>(sector) + 0.5f) / sectors;
                lost += 2 * mu * (1 - dot(stretched_albedo_split(direction(mu, 1.5707963f * turn), alpha), vec2(1))) / (rings * sectors);
            }
        const double share = lost / std::max(1e-6, 1.0 - dot(stretched_split_average(alpha), vec2(1)));
        const double energy = stretched_energy(wo, alpha, 192) + (1 - dot(stretched_albedo_split(wo, alpha), vec2(1))) * share;
        least = std::min(least, energy);
        most = std::max(most, energy);
    }
    RecordProperty("least", std::to_string(least));
    RecordProperty("most", std::to_string(most));
    EXPECT_GT(least, 0.995);
    EXPECT_LT(most, 1.002);
}

TEST(Anisotropy, AStretchedLobeOfEqualAxesIsTheIsotropicOne) {
    for (std::uint32_t i = 0; i < 100; ++i) {
        const vec4 u = random4(i, 0, 0, 3);
        const float alpha = 0.05f + 0.9f * u.x;
        const vec3 wo = direction(0.05f + 0.9f * u.y, 1), wi = direction(0.05f + 0.9f * u.z, 5 * u.w), h = normalize(wo + wi);
        EXPECT_NEAR(ggx_reflection_stretched(wo, wi, h, vec2(alpha)), ggx_reflection(wo, wi, h, alpha), 1e-4f * ggx_reflection(wo, wi, h, alpha));
        EXPECT_NEAR(ggx_reflection_pdf_stretched(wo, h, vec2(alpha)), ggx_reflection_pdf(wo, h, alpha), 1e-4f * ggx_reflection_pdf(wo, h, alpha));
    }
}

TEST(Anisotropy, WhiteFurnaceReturnsOneWithinTheQuadraturesError) {
    double least = 2, most = 0;
    for (float metallic : {0.0f, 1.0f})
        for (float roughness : {0.2f, 0.4f, 0.7f})
            for (float anisotropy : {0.3f, 0.6f, 1.0f})
                for (float mu : cosines)
                    for (float azimuth : {0.0f, 0.8f, 1.5707f}) {
                        const Surface surface = stretched_surface(vec3(1), metallic, roughness, anisotropy);
                        const double energy = returned_energy(surface, direction(mu, azimuth), 8192).y;
                        least = std::min(least, energy);
                        most = std::max(most, energy);
                    }
    RecordProperty("least", std::to_string(least));
    RecordProperty("most", std::to_string(most));
    EXPECT_GT(least, 0.994);
    EXPECT_LT(most, 1.006);
}

TEST(Anisotropy, TheHighlightIsLongAcrossTheSmoothAxis) {
    // KHR_materials_anisotropy: α is larger along the tangent.
    const Surface surface = stretched_surface(vec3(1), 1, 0.3f, 0.8f);
    const vec3 wo(0, 0, 1);
    EXPECT_GT(bsdf_evaluate(surface, wo, direction(0.9f, 0)).x, 8 * bsdf_evaluate(surface, wo, direction(0.9f, pi / 2)).x);
}

// -- sheen

TEST(Sheen, ItsAlbedoIsTheIntegralAndNeverMoreThanOne) {
    for (float roughness : {0.1f, 0.3f, 0.5f, 0.8f, 1.0f})
        for (float mu : {0.05f, 0.2f, 0.5f, 1.0f}) {
            const vec3 wo = direction(mu);
            double sum = 0;
            constexpr std::uint32_t samples = 1 << 14;
            for (std::uint32_t i = 0; i < samples; ++i) {
                const vec3 u = cube_point(i), wi = sample_uniform_hemisphere(vec2(u));
                sum += sheen_reflection(wo, wi, normalize(wo + wi), sheen_alpha(roughness)) / uniform_hemisphere_pdf / samples;
            }
            EXPECT_NEAR(sheen_albedo(mu, roughness), sum, 0.01) << roughness << ' ' << mu;
            EXPECT_LE(sum, 1) << roughness << ' ' << mu;
        }
}

// -- thin films

glm::dvec3 spectral_film(double mu, double film_ior, double thickness_nm, double base_ior) {
    // Airy's reflectance of the amplitudes of both polarizations: Born & Wolf, Principles of Optics, 7.6.
    return reflectance_to_rgb([&](double nm) {
        const double sine2 = 1 - mu * mu, cos_film = std::sqrt(1 - sine2 / (film_ior * film_ior)),
                     cos_base = std::sqrt(1 - sine2 / (base_ior * base_ior));
        const double phase = 4 * 3.14159265358979 * film_ior * thickness_nm * cos_film / nm;
        const auto airy = [&](double r1, double r2) {
            const double cross = 2 * r1 * r2 * std::cos(phase);
            return (r1 * r1 + r2 * r2 + cross) / (1 + r1 * r1 * r2 * r2 + cross);
        };
        const double s = airy((mu - film_ior * cos_film) / (mu + film_ior * cos_film),
                              (film_ior * cos_film - base_ior * cos_base) / (film_ior * cos_film + base_ior * cos_base));
        const double p = airy((film_ior * mu - cos_film) / (film_ior * mu + cos_film),
                              (base_ior * cos_film - film_ior * cos_base) / (base_ior * cos_film + film_ior * cos_base));
        return 0.5 * (s + p);
    });
}

TEST(ThinFilm, ColoursAreThoseOfTheSpectrum) {
    double worst = 0;
    for (double thickness : {150.0, 300.0, 450.0, 700.0})
        for (double mu : {1.0, 0.8, 0.6}) {
            const glm::dvec3 expected = glm::clamp(spectral_film(mu, 1.4, thickness, 2.0), 0.0, 1.0);
            const vec3 found = fresnel_thin_film(static_cast<float>(mu), 1.4f, static_cast<float>(thickness), vec3(1.0f / 9));
            for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(found[c] - expected[c]));
        }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 0.025);
}

TEST(ThinFilm, NoThicknessIsNoFilm) {
    for (float mu : cosines) EXPECT_NEAR(fresnel_thin_film(mu, 1.4f, 0, vec3(0.04f)).x, fresnel_schlick(vec3(0.04f), 1, mu).x, 1e-4f);
}

// -- sheets

TEST(Sheets, AWhiteOneReflectsOrPassesAllLight) {
    for (float ior : {1.2f, 1.5f, 2.2f})
        for (float roughness : {0.0f, 0.2f, 0.5f, 1.0f})
            for (float mu : cosines)
                EXPECT_NEAR(returned_energy(sheet_surface(roughness, ior), direction(mu), 1 << 14).y, 1, 0.006) << ior << ' ' << roughness << ' ' << mu;
}

TEST(Sheets, SmoothOnesSendLightStraightOnInTheirColour) {
    Surface surface = sheet_surface(0, 1.5f);
    surface.base_color = {0.25f, 1, 1};
    const vec3 wo = direction(0.7f, 1);
    for (std::uint32_t i = 0; i < 200; ++i) {
        const BsdfSample sample = bsdf_sample(surface, wo, cube_point(i));
        if (!sample.transmitted) continue;
        EXPECT_GT(dot(sample.direction, -wo), 0.99f);
        EXPECT_EQ(sample.eta_scale, 1);
    }
    const glm::dvec3 energy = returned_energy(surface, wo, 1 << 14);
    const double reflected = fresnel_dielectric(0.7f, 1.5f);
    EXPECT_NEAR(energy.x, reflected + 0.25 * (1 - reflected), 0.003);
    EXPECT_NEAR(energy.y, 1, 0.003);
}

// -- all of them

TEST(ExtendedModels, AreReciprocal) {
    for (const NamedSurface& test : extended_surfaces())
        for (std::uint32_t i = 0; i < 200; ++i) {
            const vec4 u = random4(i, 3, 0, 7);
            const vec3 a = direction(0.05f + 0.95f * u.x, 6 * u.y);
            vec3 b = direction(0.05f + 0.95f * u.z, 6 * u.w);
            const vec3 there = bsdf_evaluate(test.surface, a, b) / b.z, back = bsdf_evaluate(test.surface, b, a) / a.z;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], 3e-4f * (1e-3f + there[c])) << test.name << ' ' << i;
            if (!test.surface.thin_walled) continue;
            // Seen from behind, a sheet is turned over: x stays, z and y change sign.
            b.z = -b.z;
            const vec3 through = bsdf_evaluate(test.surface, a, b) / -b.z;
            const vec3 other = bsdf_evaluate(test.surface, vec3(b.x, -b.y, -b.z), vec3(a.x, -a.y, -a.z)) / a.z;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(through[c], other[c], 3e-4f * (1e-3f + through[c])) << test.name << ' ' << i;
        }
}

TEST(ExtendedModels, ReturnNoMoreThanTheyReceiveExceptDisneys) {
    for (NamedSurface test : extended_surfaces()) {
        if (test.surface.model == material_model_disney) continue;
        if (!test.surface.conductor) test.surface.base_color = vec3(1);
        double most = 0;
        for (float mu : {0.05f, 0.2f, 0.5f, 1.0f})
            for (float azimuth : {0.0f, 0.8f, 1.57f}) {
                const glm::dvec3 energy = returned_energy(test.surface, direction(mu, azimuth), 8192);
                most = std::max({most, energy.x, energy.y, energy.z});
            }
        RecordProperty(test.name, std::to_string(most));
        EXPECT_LE(most, 1.006) << test.name;
    }
}

bool finite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

TEST(ExtendedModels, StayFiniteAtTheirLimitsAndForGrazingViews) {
    for (std::uint32_t i = 0; i < 600; ++i) {
        const vec4 a = random4(i, 0, 0, 9), b = random4(i, 1, 0, 9), c = random4(i, 2, 0, 9);
        const auto edge = [](float u) { return u < 0.3f ? 0.0f : u < 0.6f ? 1.0f : (u - 0.6f) * 2.5f; };
        Surface surface = extended_surface(vec3(edge(a.x)), edge(a.y), edge(a.z));
        const std::uint32_t models[] = {material_model_standard, material_model_standard, material_model_disney, material_model_oren_nayar};
        surface.model = models[i % 4];
        surface.transmission = edge(a.w);
        surface.anisotropy = edge(b.x);
        surface.sheen_color = vec3(edge(b.y));
        surface.sheen_roughness = edge(b.z);
        surface.iridescence = edge(b.w);
        surface.film_thickness_nm = 1000 * edge(c.x);
        surface.film_ior = 1 + edge(c.y);
        surface.thin_walled = c.z < 0.5f;
        surface.conductor = c.w < 0.3f;
        surface.k = vec3(edge(c.x) * 10);
        surface.sheen = edge(c.x);
        surface.clearcoat = edge(c.y);
        surface.clearcoat_gloss = edge(c.z);
        surface.subsurface = edge(c.w);
        surface.sigma = c.x < 0.5f ? -1 : edge(c.y);
        surface.inside = !surface.thin_walled && i % 3 == 0 && surface.transmission > 0 && surface.model == material_model_standard;
        for (float mu : {1e-7f, 1e-3f, 0.7f, 1.0f}) {
            const vec3 wo = direction(mu, 0.3f);
            ASSERT_TRUE(finite(bsdf_albedo(surface, wo))) << i << ' ' << mu;
            for (std::uint32_t k = 0; k < 12; ++k) {
                const vec3 u = k == 0 ? vec3(0) : k == 1 ? vec3(0.99999994f) : cube_point(k);
                const BsdfSample sample = bsdf_sample(surface, wo, u);
                ASSERT_TRUE(finite(sample.weight) && std::isfinite(sample.pdf) && sample.pdf >= 0) << i << ' ' << mu << ' ' << k;
                const vec3 wi = k % 3 == 0 ? vec3(-wo.x, -wo.y, wo.z) : k % 3 == 1 ? -wo : direction(1e-7f, 2.0f);
                ASSERT_TRUE(finite(bsdf_evaluate(surface, wo, wi))) << i << ' ' << mu << ' ' << k;
                ASSERT_TRUE(std::isfinite(bsdf_pdf(surface, wo, wi))) << i << ' ' << mu << ' ' << k;
            }
        }
    }
}

TEST(ExtendedModels, AlbedosAreCloseToTheIntegralsOfTheLobes) {
    // What stands for them under a sky in real time and samples their lobes. Films go by a bound, Oren & Nayar's by the
    // base colour.
    for (const NamedSurface& test : extended_surfaces()) {
        if (test.surface.iridescence > 0 || test.surface.sigma >= 0) continue;
        for (float mu : {0.4f, 0.9f}) {
            const vec3 wo = direction(mu, 0.5f);
            const glm::dvec3 energy = returned_energy(test.surface, wo, 1 << 14);
            const BsdfLobes lobes = bsdf_prepare(test.surface, wo);
            const vec3 albedo = bsdf_albedo(test.surface, wo) + bsdf_transmission_albedo_prepared(test.surface, lobes);
            const float bound = test.surface.model == material_model_disney ? 0.12f : 0.06f;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(albedo[c], energy[c], bound) << test.name << ' ' << mu << ' ' << c;
        }
    }
}

}  // namespace
}  // namespace heliodon::shading
