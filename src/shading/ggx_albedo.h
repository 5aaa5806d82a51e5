// Directional albedo of the GGX lobes, from tables. A GLSL includer defines
// `float shading_table(uint index)` over the array of shading/tables.h; in C++ that header has it.
//
// Reflection with Schlick's Fresnel splits into E(μ) = F0 · A(μ, α) + F90 · B(μ, α) (Karis 2013), so that
// two tables serve every material, and A + B is the albedo at Fresnel 1. Columns are even in √μ, rows in
// √α: the functions bend at grazing angles and on smooth surfaces. Measured between the entries: E is off
// by less than 5·10⁻⁴ for μ ≥ 0.1, 2.5·10⁻³ at the most below (tests/shading/ggx_test.cpp). The averages
// 2 ∫ E μ dμ are the exact integrals of the interpolated rows, so that the multiple-scattering lobe gives
// back exactly what the table says is missing.
//
// Glass (reflection and refraction with the exact Fresnel term) has its albedo in three dimensions, for
// light that arrives from the thin and from the dense side; its columns are even in μ (1 + α)/(μ + α),
// because what a facet loses at grazing angles depends on μ/α.
#ifndef HELIODON_SHADING_GGX_ALBEDO_H
#define HELIODON_SHADING_GGX_ALBEDO_H
#include "shading/ggx.h"
#ifdef __cplusplus
#include "shading/tables.h"
#endif
SHADING_BEGIN

// The array: A, B interleaved, row by row; averages of A, B a row; glass by side (thin, dense), index,
// row, column; its averages by side, index, row; the average Fresnel reflectance by index; lobe_cone.h's pairs;
// reflected_light.h's triples.
SHADING_CONST uint ggx_albedo_columns = 64u;
SHADING_CONST uint ggx_albedo_rows = 128u;
SHADING_CONST uint ggx_albedo_averages = 2u * 128u * 64u;
SHADING_CONST uint glass_columns = 24u;
SHADING_CONST uint glass_rows = 16u;
SHADING_CONST uint glass_indices = 12u;
SHADING_CONST uint glass_albedo_start = 2u * 128u * 64u + 2u * 128u;
SHADING_CONST uint glass_average_start = 2u * 128u * 64u + 2u * 128u + 2u * 12u * 16u * 24u;
SHADING_CONST uint glass_fresnel_start = 2u * 128u * 64u + 2u * 128u + 2u * 12u * 16u * 24u + 2u * 12u * 16u;
SHADING_CONST uint specular_lobe_columns = 48u;
SHADING_CONST uint specular_lobe_rows = 48u;
SHADING_CONST uint specular_lobe_layers = 2u;  // at Fresnel 1, and for an F0 of lobe_dielectric_f0
SHADING_CONST float lobe_dielectric_f0 = 0.04f;  // of index 1.5
SHADING_CONST uint specular_lobe_start = 2u * 128u * 64u + 2u * 128u + 2u * 12u * 16u * 24u + 2u * 12u * 16u + 12u;
SHADING_CONST uint reflected_lobe_columns = 32u;
SHADING_CONST uint reflected_lobe_rows = 32u;
SHADING_CONST uint reflected_lobe_start = specular_lobe_start + 2u * 2u * 48u * 48u;  // layers as before
// Of what SHADING_EXTENDED models look up (ggx_anisotropic.h, sheen.h), after all of the others.
SHADING_CONST uint stretched_rows = 20u;      // of √α along the direction
SHADING_CONST uint stretched_breadths = 20u;  // of √α across it
SHADING_CONST uint stretched_shears = 5u;     // of (αx αy / both of these)²
SHADING_CONST uint stretched_columns = 18u;   // of √μ
SHADING_CONST uint stretched_averages = 32u;  // of √αx and of √αy
SHADING_CONST uint stretched_albedo_start = reflected_lobe_start + 3u * 2u * 32u * 32u;
SHADING_CONST uint stretched_average_start = stretched_albedo_start + 2u * 20u * 20u * 5u * 18u;
SHADING_CONST uint sheen_rows = 16u;     // of roughness
SHADING_CONST uint sheen_columns = 24u;  // of √μ
SHADING_CONST uint sheen_albedo_start = stretched_average_start + 2u * 32u * 32u;
SHADING_CONST uint shading_table_size = sheen_albedo_start + 16u * 24u;
SHADING_CONST float glass_largest_f0_root = 0.5f;  // (n − 1)/(n + 1) of the last index, n = 3

#ifndef __cplusplus
float shading_table(uint index);
#endif

/// √α, from 0 at the smoothest to 1.
SHADING_FN float alpha_coordinate(float alpha) {
    float smallest = sqrt(ggx_smallest_alpha);
    return clamp((sqrt(alpha) - smallest) / (1.0f - smallest), 0.0f, 1.0f);
}
SHADING_FN vec2 ggx_albedo_entry(uint index) {
    return vec2(shading_table(index), shading_table(index + 1u));
}

/// (A, B) at cosine `mu`, bilinear.
SHADING_FN vec2 ggx_albedo_split(float mu, float alpha) {
    float row = alpha_coordinate(alpha) * float(ggx_albedo_rows - 1u);
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
    float row = alpha_coordinate(alpha) * float(ggx_albedo_rows - 1u);
    uint j = min(uint(row), ggx_albedo_rows - 2u);
    uint index = ggx_albedo_averages + 2u * j;
    return mix(ggx_albedo_entry(index), ggx_albedo_entry(index + 2u), row - float(j));
}

/// What light scattered more than once between the facets keeps: Kulla & Conty 2017, "Revisiting
/// Physically Based Shading at Imageworks", Favg² Eavg / (1 − Favg (1 − Eavg)); all of it at Fresnel 1.
SHADING_FN vec3 multiple_scattering_fresnel(vec3 f_average, float e_average) {
    return f_average * f_average * e_average / (vec3(1.0f) - f_average * (1.0f - e_average));
}

/// Place of relative index `eta` (beyond / on the viewer's side) in the glass tables: first entry's index
/// and fraction towards the next.
SHADING_FN uint glass_index(float eta, SHADING_OUT(float) fraction) {
    float dense = max(eta, 1.0f / eta);
    float coordinate =
        clamp((dense - 1.0f) / (dense + 1.0f) / glass_largest_f0_root, 0.0f, 1.0f) * float(glass_indices - 1u);
    uint k = min(uint(coordinate), glass_indices - 2u);
    fraction = coordinate - float(k);
    return eta >= 1.0f ? k : k + glass_indices;
}
SHADING_FN float glass_albedo_row(uint first, float x) {
    return mix(shading_table(first), shading_table(first + 1u), x);
}
/// Reflected plus refracted part of the light that single scattering returns from cosine `mu`, trilinear.
SHADING_FN float glass_albedo(float mu, float alpha, float eta) {
    float z;
    uint k = glass_index(eta, z);
    float row = alpha_coordinate(alpha) * float(glass_rows - 1u);
    float c = clamp(mu, 0.0f, 1.0f);
    float column = c * (1.0f + alpha) / (c + alpha) * float(glass_columns - 1u);
    uint j = min(uint(row), glass_rows - 2u);
    uint i = min(uint(column), glass_columns - 2u);
    uint first = glass_albedo_start + (k * glass_rows + j) * glass_columns + i;
    uint layer = glass_rows * glass_columns;
    float x = column - float(i);
    float y = row - float(j);
    float near_index = mix(glass_albedo_row(first, x), glass_albedo_row(first + glass_columns, x), y);
    float far_index = mix(glass_albedo_row(first + layer, x), glass_albedo_row(first + layer + glass_columns, x), y);
    return mix(near_index, far_index, z);
}
SHADING_FN float glass_albedo_average(float alpha, float eta) {
    float z;
    uint k = glass_index(eta, z);
    float row = alpha_coordinate(alpha) * float(glass_rows - 1u);
    uint j = min(uint(row), glass_rows - 2u);
    uint first = glass_average_start + k * glass_rows + j;
    float y = row - float(j);
    return mix(glass_albedo_row(first, y), glass_albedo_row(first + glass_rows, y), z);
}
/// Cosine-weighted average of the exact Fresnel reflectance. From the dense side it follows from the thin
/// side's: as much light passes either way, n² (1 − Favg) of the dense = 1 − Favg of the thin.
SHADING_FN float glass_fresnel_average(float eta) {
    float z;
    uint k = glass_index(max(eta, 1.0f / eta), z);
    float thin = glass_albedo_row(glass_fresnel_start + k, z);
    return eta >= 1.0f ? thin : 1.0f - (1.0f - thin) * eta * eta;
}

SHADING_END
#endif
