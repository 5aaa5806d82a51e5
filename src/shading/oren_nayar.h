// Rough diffuse surfaces. By `roughness`, the energy-preserving model of Portsmouth, Kutz & Hill 2024, "EON: A Practical
// Energy-Preserving Rough Diffuse BRDF": Fujii's form of Oren & Nayar's and what it scatters more than once. By the facets'
// standard deviation, the qualitative model of Oren & Nayar 1994, "Generalization of Lambert's Reflectance Model", eq. 30.
#ifndef HELIODON_SHADING_OREN_NAYAR_H
#define HELIODON_SHADING_OREN_NAYAR_H
#include "shading/sampling.h"
SHADING_BEGIN

/// cos Δφ sin α tan β = s/t of two directions, s = cos Δφ sin θo sin θi, t = max(μo, μi).
SHADING_FN float oren_nayar_s(vec3 wo, vec3 wi) {
    return dot(wo, wi) - wo.z * wi.z;
}

/// Portsmouth et al. 2024, eq. 16: A of Fujii's model, whose B is roughness · A.
SHADING_FN float fujii_a(float roughness) {
    return 1.0f / (1.0f + (0.5f - 2.0f * inverse_pi / 3.0f) * roughness);
}
/// Its directional albedo for a white surface: eq. 20 and 21.
SHADING_FN float fujii_albedo(float mu, float roughness) {
    float c = clamp(mu, 1.0e-4f, 1.0f);
    float s = sqrt(max(0.0f, 1.0f - c * c));
    float g = s * (acos(c) - s * c) + (2.0f / 3.0f) * (s / c * (1.0f - s * s * s) - s);
    return fujii_a(roughness) * (1.0f + roughness * inverse_pi * g);
}
/// And the average of that: eq. 22.
SHADING_FN float fujii_albedo_average(float roughness) {
    return fujii_a(roughness) * (1.0f + (2.0f / 3.0f - 28.0f * inverse_pi / 15.0f) * roughness);
}
/// f · cos θi: eq. 15, 28 and 29.
SHADING_FN vec3 eon_evaluate(vec3 albedo, float roughness, vec3 wo, vec3 wi) {
    float s = oren_nayar_s(wo, wi);
    float s_over_t = s > 0.0f ? s / max(wo.z, wi.z) : s;
    vec3 single = albedo * (fujii_a(roughness) * (1.0f + roughness * s_over_t));
    float average = fujii_albedo_average(roughness);
    vec3 kept = albedo * albedo * average / (vec3(1.0f) - albedo * (1.0f - average));
    float lost = (1.0f - fujii_albedo(wo.z, roughness)) * (1.0f - fujii_albedo(wi.z, roughness));
    return (single + kept * (lost / max(1.0f - average, 1.0e-7f))) * (inverse_pi * wi.z);
}
/// Its whole directional albedo.
SHADING_FN vec3 eon_albedo(vec3 albedo, float roughness, float mu) {
    float average = fujii_albedo_average(roughness);
    float single = fujii_albedo(mu, roughness);
    vec3 kept = albedo * albedo * average / (vec3(1.0f) - albedo * (1.0f - average));
    return albedo * single + kept * (1.0f - single);
}

/// f · cos θi; `sigma` in radians.
SHADING_FN vec3 oren_nayar_evaluate(vec3 albedo, float sigma, vec3 wo, vec3 wi) {
    float s2 = sigma * sigma;
    float a = 1.0f - 0.5f * s2 / (s2 + 0.33f);
    float b = 0.45f * s2 / (s2 + 0.09f);
    float s = max(oren_nayar_s(wo, wi), 0.0f);
    return albedo * ((a + b * s / max(max(wo.z, wi.z), 1.0e-6f)) * inverse_pi * wi.z);
}

SHADING_END
#endif
