// Fuzz of fibres that stand on a surface: Estevez & Kulla 2017, "Production Friendly Microfacet Sheen BRDF", as
// KHR_materials_sheen takes it, without the softening of the terminator, which is not reciprocal.
#ifndef HELIODON_SHADING_SHEEN_H
#define HELIODON_SHADING_SHEEN_H
#include "shading/ggx_albedo.h"
SHADING_BEGIN

/// KHR_materials_sheen: α = roughness². Below roughness 0.2 the published fit of the masking would return more light at
/// grazing angles than arrives.
SHADING_FN float sheen_alpha(float roughness) {
    return clamp(roughness * roughness, 0.04f, 1.0f);
}
/// D(h), per steradian: their eq. 2; `cos_h` to the normal.
SHADING_FN float sheen_distribution(float cos_h, float alpha) {
    float sin2 = max(1.0f - cos_h * cos_h, 1.0e-7f);
    float exponent = 1.0f / alpha;
    return (2.0f + exponent) * pow(sin2, 0.5f * exponent) * (0.5f * inverse_pi);
}
/// Their table 1, for roughness 0 and 1, and eq. 3.
SHADING_FN float sheen_lambda_exponent(float mu, float alpha) {
    float t = (1.0f - alpha) * (1.0f - alpha);
    float a = mix(21.5473f, 25.3245f, t);
    float b = mix(3.82987f, 3.32435f, t);
    float c = mix(0.19823f, 0.16801f, t);
    float d = mix(-1.97760f, -1.27393f, t);
    float e = mix(-4.32054f, -4.85967f, t);
    return a / (1.0f + b * pow(max(mu, 1.0e-6f), c)) + d * mu + e;
}
SHADING_FN float sheen_lambda(float mu, float alpha) {
    float value = mu < 0.5f ? sheen_lambda_exponent(mu, alpha)
                            : 2.0f * sheen_lambda_exponent(0.5f, alpha) - sheen_lambda_exponent(1.0f - mu, alpha);
    return exp(value);
}
/// f · cos θi of a white sheen: D V μi, the visibility V = G2/(4 μo μi) no more than 1 (as glTF's reference has it).
SHADING_FN float sheen_reflection(vec3 wo, vec3 wi, vec3 h, float alpha) {
    float masking = 1.0f + sheen_lambda(wo.z, alpha) + sheen_lambda(wi.z, alpha);
    return sheen_distribution(h.z, alpha) * min(1.0f / (masking * 4.0f * wo.z), wi.z);
}
/// Its directional albedo, bilinear in √μ and roughness.
SHADING_FN float sheen_albedo(float mu, float roughness) {
    float row = clamp(roughness, 0.0f, 1.0f) * float(sheen_rows - 1u);
    float column = sqrt(clamp(mu, 0.0f, 1.0f)) * float(sheen_columns - 1u);
    uint j = min(uint(row), sheen_rows - 2u);
    uint i = min(uint(column), sheen_columns - 2u);
    uint first = sheen_albedo_start + j * sheen_columns + i;
    float x = column - float(i);
    float low = mix(shading_table(first), shading_table(first + 1u), x);
    float high = mix(shading_table(first + sheen_columns), shading_table(first + sheen_columns + 1u), x);
    return mix(low, high, row - float(j));
}

SHADING_END
#endif
