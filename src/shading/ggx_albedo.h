// Directional albedo of the GGX reflection lobe, from tables. With Schlick's Fresnel it splits into
// E(μ) = F0 · A(μ, α) + F90 · B(μ, α) (Karis 2013), so that two tables serve every material, and
// A + B is the albedo at Fresnel 1.
//
// A GLSL includer defines `float shading_table(uint index)` over the array of shading/tables.h.
//
// Layout: A, B interleaved, column i of √μ = i/(columns − 1), row j of √α evenly from √α_smallest to 1;
// then the averages 2 ∫ A μ dμ, 2 ∫ B μ dμ a row. √μ and √α put the entries where the functions bend:
// at grazing angles and on smooth surfaces. The averages are the exact integrals of the interpolated
// rows, so that the multiple-scattering lobe gives back exactly what the table says is missing.
#ifndef HELIODON_SHADING_GGX_ALBEDO_H
#define HELIODON_SHADING_GGX_ALBEDO_H
#include "shading/ggx.h"
#ifdef __cplusplus
#include "shading/tables.h"
#endif
SHADING_BEGIN

SHADING_CONST uint ggx_albedo_columns = 64u;
SHADING_CONST uint ggx_albedo_rows = 64u;
SHADING_CONST uint ggx_albedo_averages = 2u * 64u * 64u;  // where the averages begin
SHADING_CONST uint shading_table_size = 2u * 64u * 64u + 2u * 64u;

#ifndef __cplusplus
float shading_table(uint index);
#endif

SHADING_FN float ggx_albedo_row(float alpha) {
    float smallest = sqrt(ggx_smallest_alpha);
    return clamp((sqrt(alpha) - smallest) / (1.0f - smallest), 0.0f, 1.0f) * float(ggx_albedo_rows - 1u);
}
SHADING_FN vec2 ggx_albedo_entry(uint index) { return vec2(shading_table(index), shading_table(index + 1u)); }

/// (A, B) at cosine `mu`, bilinear.
SHADING_FN vec2 ggx_albedo_split(float mu, float alpha) {
    float row = ggx_albedo_row(alpha);
    float column = sqrt(clamp(mu, 0.0f, 1.0f)) * float(ggx_albedo_columns - 1u);
    uint j = min(uint(row), ggx_albedo_rows - 2u);
    uint i = min(uint(column), ggx_albedo_columns - 2u);
    uint index = 2u * (j * ggx_albedo_columns + i);
    uint next = index + 2u * ggx_albedo_columns;
    float x = column - float(i);
    vec2 low = mix(ggx_albedo_entry(index), ggx_albedo_entry(index + 2u), x);
    vec2 high = mix(ggx_albedo_entry(next), ggx_albedo_entry(next + 2u), x);
    return mix(low, high, row - float(j));
}
/// Their averages over the hemisphere, 2 ∫ · μ dμ.
SHADING_FN vec2 ggx_albedo_split_average(float alpha) {
    float row = ggx_albedo_row(alpha);
    uint j = min(uint(row), ggx_albedo_rows - 2u);
    uint index = ggx_albedo_averages + 2u * j;
    return mix(ggx_albedo_entry(index), ggx_albedo_entry(index + 2u), row - float(j));
}

/// What light scattered more than once between the facets keeps: Kulla & Conty 2017, slide 16 in the
/// form that returns all of it at Fresnel 1, Favg² Eavg / (1 − Favg (1 − Eavg)).
SHADING_FN vec3 multiple_scattering_fresnel(vec3 f_average, float e_average) {
    return f_average * f_average * e_average / (vec3(1.0f) - f_average * (1.0f - e_average));
}

SHADING_END
#endif
