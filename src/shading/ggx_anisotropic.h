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

// The albedo of a stretched lobe depends on four numbers. Seen from a direction, the facets' slopes have α along it, α
// across it, and a shear where its azimuth is none of the axes; of the shear only the square counts, by symmetry. What
// the albedo has more than an isotropic lobe's of the α along (by which alone facets hide from that direction) is small
// and smooth: that is in the table.

/// (α² along w, α² across it, squared share of their product that the axes' product is: 1 without shear).
SHADING_FN vec3 stretched_slopes(vec3 w, vec2 alpha) {
    float x2 = alpha.x * alpha.x;
    float y2 = alpha.y * alpha.y;
    float sine2 = w.x * w.x + w.y * w.y;
    float along = sine2 > 1.0e-12f ? (x2 * w.x * w.x + y2 * w.y * w.y) / sine2 : x2;
    float across = x2 + y2 - along;
    return vec3(along, across, min(x2 * y2 / (along * across), 1.0f));
}
SHADING_FN vec2 stretched_line(uint first, float x) {
    return mix(ggx_albedo_entry(first), ggx_albedo_entry(first + 2u), x);
}
SHADING_FN vec2 stretched_plane(uint first, float x, float y) {
    return mix(stretched_line(first, x), stretched_line(first + 2u * stretched_columns, x), y);
}
SHADING_FN vec2 stretched_block(uint first, float x, float y, float z) {
    uint next = first + 2u * stretched_columns * stretched_shears;
    return mix(stretched_plane(first, x, y), stretched_plane(next, x, y), z);
}
/// (A, B) as ggx_albedo_split: the isotropic table's, and the difference quadrilinear in the roots of α along and across
/// `w`, the shear and √μ.
SHADING_FN vec2 stretched_albedo_split(vec3 w, vec2 alpha) {
    vec3 slopes = stretched_slopes(w, alpha);
    float along = sqrt(slopes.x);
    float row = alpha_coordinate(along) * float(stretched_rows - 1u);
    float breadth = alpha_coordinate(sqrt(slopes.y)) * float(stretched_breadths - 1u);
    float shear = slopes.z * float(stretched_shears - 1u);
    float column = sqrt(clamp(w.z, 0.0f, 1.0f)) * float(stretched_columns - 1u);
    uint j = min(uint(row), stretched_rows - 2u);
    uint b = min(uint(breadth), stretched_breadths - 2u);
    uint s = min(uint(shear), stretched_shears - 2u);
    uint i = min(uint(column), stretched_columns - 2u);
    uint first = stretched_albedo_start +
                 2u * (((j * stretched_breadths + b) * stretched_shears + s) * stretched_columns + i);
    uint next = first + 2u * stretched_columns * stretched_shears * stretched_breadths;
    float x = column - float(i);
    float y = shear - float(s);
    float z = breadth - float(b);
    vec2 more = mix(stretched_block(first, x, y, z), stretched_block(next, x, y, z), row - float(j));
    return max(ggx_albedo_split(w.z, along) + more, vec2(0.0f));
}
/// Their averages over the hemisphere, 2 ∫ · μ dμ: bilinear in the roots of both α.
SHADING_FN vec2 stretched_split_average(vec2 alpha) {
    float column = alpha_coordinate(alpha.x) * float(stretched_averages - 1u);
    float row = alpha_coordinate(alpha.y) * float(stretched_averages - 1u);
    uint i = min(uint(column), stretched_averages - 2u);
    uint j = min(uint(row), stretched_averages - 2u);
    uint first = stretched_average_start + 2u * (j * stretched_averages + i);
    float x = column - float(i);
    return mix(stretched_line(first, x), stretched_line(first + 2u * stretched_averages, x), row - float(j));
}

SHADING_END
#endif
