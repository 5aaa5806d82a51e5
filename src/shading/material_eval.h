// From a material's record and what its textures hold at one point to a Surface and a shading normal.
// No fetches here: material_fetch.h makes them through the includer.
#ifndef HELIODON_SHADING_MATERIAL_EVAL_H
#define HELIODON_SHADING_MATERIAL_EVAL_H
#include "shading/bsdf.h"
SHADING_BEGIN

/// Everything of a material at one point but its normal.
struct MaterialPoint {
    Surface surface;
    vec3 emission;    // radiance, cd/m²
    float opacity;    // 0 or 1 for masked materials
    float occlusion;  // of indirect diffuse light, 1 = open
};

/// What the material's textures hold, sRGB decoded; 1 (normals: 0.5, 0.5, 1) where there is none.
struct MaterialTexels {
    vec4 base_color;
    vec3 orm;  // roughness G, metallic B
    float occlusion;
    vec3 emission;
    float transmission;
    float specular;
    vec3 specular_color;
    float clearcoat;
    float clearcoat_roughness;
};

SHADING_FN MaterialTexels material_texels_default() {
    MaterialTexels t;
    t.base_color = vec4(1.0f);
    t.orm = vec3(1.0f);
    t.occlusion = 1.0f;
    t.emission = vec3(1.0f);
    t.transmission = 1.0f;
    t.specular = 1.0f;
    t.specular_color = vec3(1.0f);
    t.clearcoat = 1.0f;
    t.clearcoat_roughness = 1.0f;
    return t;
}

/// Coverage in [0, 1]: `alpha` is the base colour texel's times the vertex colour's.
SHADING_FN float material_opacity(MaterialData m, float alpha) {
    float opacity = m.opacity * alpha;
    if ((m.flags & material_flag_alpha_mask) != 0u) {
        return opacity >= m.alpha_cutoff ? 1.0f : 0.0f;
    }
    return (m.flags & material_flag_alpha_blend) != 0u ? clamp(opacity, 0.0f, 1.0f) : 1.0f;
}

/// Share of the light that a thin pane lets pass straight on, by the cosine of incidence on either side.
SHADING_FN float thin_transmittance(SHADING_IN(MaterialData) m, float cosine) {
    float c = min(abs(cosine), 1.0f);
    vec4 low = m.transmittance;
    vec2 high = m.transmittance_high;
    return clamp(low.x + c * (low.y + c * (low.z + c * (low.w + c * (high.x + c * high.y)))), 0.0f, 1.0f);
}

/// glTF 2.0's products of factor, texel and vertex colour. `inside`: see Surface.
SHADING_FN MaterialPoint material_combine(MaterialData m, MaterialTexels t, vec4 vertex_color, bool inside) {
    MaterialPoint p;
    p.surface.base_color = m.base_color * vec3(t.base_color) * vec3(vertex_color);
    p.surface.metallic = clamp(m.metallic * t.orm.z, 0.0f, 1.0f);
    p.surface.specular_color = m.specular_color * t.specular_color;
    p.surface.specular = clamp(m.specular * t.specular, 0.0f, 1.0f);
    p.surface.roughness = clamp(m.roughness * t.orm.y, 0.0f, 1.0f);
    p.surface.ior = m.ior;
    p.surface.transmission = clamp(m.transmission * t.transmission, 0.0f, 1.0f);
    p.surface.clearcoat = clamp(m.clearcoat * t.clearcoat, 0.0f, 1.0f);
    p.surface.clearcoat_roughness = clamp(m.clearcoat_roughness * t.clearcoat_roughness, 0.0f, 1.0f);
    p.surface.model = m.model == material_model_thin ? material_model_standard : m.model;  // what a pane reflects is a mirror's
    p.surface.inside = inside && m.model == material_model_standard && p.surface.transmission > 0.0f;
    p.emission = m.emission_nits * t.emission;
    if (m.model == material_model_unlit) {
        p.emission = p.emission * p.surface.base_color;
    }
    p.opacity = material_opacity(m, t.base_color.w * vertex_color.w);
    p.occlusion = 1.0f + m.occlusion_strength * (t.occlusion - 1.0f);
    return p;
}

/// Derivatives of position by the texture coordinates of a triangle, metres a unit of uv; false where
/// the coordinates are degenerate.
SHADING_FN bool triangle_derivatives(vec3 p0, vec3 p1, vec3 p2, vec2 uv0, vec2 uv1, vec2 uv2, SHADING_OUT(vec3) dp_du,
                                     SHADING_OUT(vec3) dp_dv) {
    vec2 a = uv1 - uv0;
    vec2 b = uv2 - uv0;
    float determinant = a.x * b.y - a.y * b.x;
    dp_du = vec3(0.0f);
    dp_dv = vec3(0.0f);
    if (abs(determinant) < 1.0e-20f) {
        return false;
    }
    vec3 e1 = p1 - p0;
    vec3 e2 = p2 - p0;
    dp_du = (e1 * b.y - e2 * a.y) / determinant;
    dp_dv = (e2 * a.x - e1 * b.x) / determinant;
    return true;
}

/// glTF 2.0: `texel` in [0, 1] holds the normal in the frame (tangent, w · n × tangent, n), y up.
SHADING_FN vec3 perturb_normal_map(vec3 n, vec4 tangent, vec3 texel, float normal_scale) {
    vec3 t = vec3(tangent) - n * dot(n, vec3(tangent));
    float squared = dot(t, t);
    if (squared < 1.0e-12f) {
        return n;
    }
    t = t * inversesqrt(squared);
    vec3 b = cross(n, t) * tangent.w;
    vec3 m = texel * 2.0f - vec3(1.0f);
    vec3 result = t * (m.x * normal_scale) + b * (m.y * normal_scale) + n * m.z;
    float length2 = dot(result, result);
    return length2 < 1.0e-12f ? n : result * inversesqrt(length2);
}

/// A height field over the surface: Blinn 1978 in the surface-gradient form of Mikkelsen 2010, eq. 3 and 4.
/// dh_du, dh_dv in metres a unit of uv, dp_du, dp_dv likewise.
SHADING_FN vec3 perturb_bump(vec3 n, vec3 dp_du, vec3 dp_dv, float dh_du, float dh_dv) {
    vec3 r1 = cross(dp_dv, n);
    vec3 r2 = cross(n, dp_du);
    float determinant = dot(dp_du, r1);
    if (abs(determinant) < 1.0e-20f) {
        return n;
    }
    return normalize(n - (r1 * dh_du + r2 * dh_dv) / determinant);
}

/// A shading normal that this viewer can use: bent, where needed, just so far that the mirror direction
/// stays above the geometric surface. Keller et al. 2017, "The Iray Light Transport Simulation and
/// Rendering System", section A.3. `wo`, `geometric` and `n` are unit; `geometric` faces `wo`.
SHADING_FN vec3 usable_shading_normal(vec3 n, vec3 geometric, vec3 wo) {
    vec3 facing = dot(n, geometric) < 0.0f ? -n : n;
    vec3 mirror = facing * (2.0f * dot(facing, wo)) - wo;
    // A thousandth over the surface lets the mirrored ray leave it in single precision.
    float lowest = min(1.0e-3f, dot(geometric, wo));
    float elevation = dot(mirror, geometric);
    if (elevation >= lowest) {
        return facing;
    }
    vec3 lifted = normalize(mirror + geometric * (lowest - elevation));
    vec3 half_way = wo + lifted;
    float squared = dot(half_way, half_way);
    return squared < 1.0e-12f ? geometric : half_way * inversesqrt(squared);
}

/// Veach 1997, section 5.3.2: whether light is reflected or transmitted is decided by the geometric
/// normal. 0 where the shading normal disagrees for `wi` (its local z is `wi_local_z`), else 1.
/// `geometric` faces the viewer.
SHADING_FN float same_side(vec3 wi, vec3 geometric, float wi_local_z) {
    return dot(wi, geometric) * wi_local_z > 0.0f ? 1.0f : 0.0f;
}

SHADING_END
#endif
