// GGX stretched along one axis of the local frame: α is (along x, along y). Heitz 2014, "Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs", section 5.3. Conventions: ggx.h.
#ifndef HELIODON_SHADING_GGX_ANISOTROPIC_H
#define HELIODON_SHADING_GGX_ANISOTROPIC_H
#include "shading/ggx_albedo.h"
SHADING_BEGIN

/// D(h), per steradian: Heitz 2014, eq. 85.
SHADING_FN float ggx_distribution_stretched(vec3 h, vec2 alpha) {
    float x = h.x / alpha.x;
    float y = h.y / alpha.y;
    float k = x * x + y * y + h.z * h.z;
    return inverse_pi / (alpha.x * alpha.y * k * k);
}
/// Λ(w): Heitz 2014, eq. 72 with the roughness that w's azimuth sees, eq. 80.
SHADING_FN float ggx_lambda_stretched(vec3 w, vec2 alpha) {
    float x = alpha.x * w.x;
    float y = alpha.y * w.y;
    float a = (x * x + y * y) / max(w.z * w.z, 1.0e-12f);
    return 0.5f * a / (sqrt(1.0f + a) + 1.0f);
}
SHADING_FN vec3 ggx_sample_visible_normal_stretched(vec3 wo, vec2 alpha, vec2 u) {
    vec3 stretched = normalize(vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z));
    float phi = 2.0f * pi * u.x;
    vec3 h = ggx_cap_normal(stretched, 1.0f, u.y, cos(phi), sin(phi));
    return normalize(vec3(alpha.x * h.x, alpha.y * h.y, h.z));
}

/// D G2/(4 μo), and the density of its sampling: as ggx_reflection and ggx_reflection_pdf.
SHADING_FN float ggx_reflection_stretched(vec3 wo, vec3 wi, vec3 h, vec2 alpha) {
    float lambda = ggx_lambda_stretched(wo, alpha) + ggx_lambda_stretched(wi, alpha);
    return ggx_distribution_stretched(h, alpha) / ((1.0f + lambda) * 4.0f * wo.z);
}
SHADING_FN float ggx_reflection_pdf_stretched(vec3 wo, vec3 h, vec2 alpha) {
    return ggx_distribution_stretched(h, alpha) / ((1.0f + ggx_lambda_stretched(wo, alpha)) * 4.0f * wo.z);
}

SHADING_FN vec2 stretched_entry(uint first, float x, float y) {
    vec2 low = mix(ggx_albedo_entry(first), ggx_albedo_entry(first + 2u), x);
    uint next = first + 2u * stretched_columns;
    return mix(low, mix(ggx_albedo_entry(next), ggx_albedo_entry(next + 2u), x), y);
}
SHADING_FN float stretched_ratio(vec2 alpha) {
    return sqrt(min(alpha.x, alpha.y) / max(alpha.x, alpha.y)) * float(stretched_ratios - 1u);
}
/// Azimuth from the axis of the longer α, 0 to 1 for a quarter turn, spread where the lobe changes with it: in the plane
/// stretched by the roots of α.
SHADING_FN float stretched_turn(vec3 w, vec2 alpha) {
    vec2 s = vec2(abs(w.x) * sqrt(alpha.x), abs(w.y) * sqrt(alpha.y));
    if (alpha.x < alpha.y) {
        s = vec2(s.y, s.x);
    }
    return s.x + s.y > 0.0f ? atan(s.y, s.x) * (2.0f * inverse_pi) : 0.0f;
}
/// (A, B) as ggx_albedo_split: quadrilinear in √(longer α), the root of the ratio of the two, stretched_turn and √μ.
SHADING_FN vec2 stretched_albedo_split(vec3 w, vec2 alpha) {
    float row = alpha_coordinate(max(alpha.x, alpha.y)) * float(stretched_rows - 1u);
    float ratio = stretched_ratio(alpha);
    float turn = stretched_turn(w, alpha) * float(stretched_turns - 1u);
    float column = sqrt(clamp(w.z, 0.0f, 1.0f)) * float(stretched_columns - 1u);
    uint j = min(uint(row), stretched_rows - 2u);
    uint r = min(uint(ratio), stretched_ratios - 2u);
    uint t = min(uint(turn), stretched_turns - 2u);
    uint i = min(uint(column), stretched_columns - 2u);
    uint plane = 2u * stretched_turns * stretched_columns;
    uint first = stretched_albedo_start + 2u * (((j * stretched_ratios + r) * stretched_turns + t) * stretched_columns + i);
    uint above = first + stretched_ratios * plane;
    float x = column - float(i);
    float y = turn - float(t);
    float z = ratio - float(r);
    vec2 low = mix(stretched_entry(first, x, y), stretched_entry(first + plane, x, y), z);
    vec2 high = mix(stretched_entry(above, x, y), stretched_entry(above + plane, x, y), z);
    return mix(low, high, row - float(j));
}
/// Their averages over the hemisphere, 2 ∫ · μ dμ.
SHADING_FN vec2 stretched_split_average(vec2 alpha) {
    float row = alpha_coordinate(max(alpha.x, alpha.y)) * float(stretched_rows - 1u);
    float ratio = stretched_ratio(alpha);
    uint j = min(uint(row), stretched_rows - 2u);
    uint r = min(uint(ratio), stretched_ratios - 2u);
    uint first = stretched_average_start + 2u * (j * stretched_ratios + r);
    uint next = first + 2u * stretched_ratios;
    float z = ratio - float(r);
    vec2 low = mix(ggx_albedo_entry(first), ggx_albedo_entry(first + 2u), z);
    vec2 high = mix(ggx_albedo_entry(next), ggx_albedo_entry(next + 2u), z);
    return mix(low, high, row - float(j));
}

SHADING_END
#endif
