// From a material's record and what its textures hold at one point to a Surface and a shading normal.
// No fetches here: material_fetch.h makes them through the includer.
#ifndef HELIODON_SHADING_MATERIAL_EVAL_H
#define HELIODON_SHADING_MATERIAL_EVAL_H
#include "shading/bsdf.h"
#include "shading/pane.h"
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
    vec3 anisotropy;  // extended, as all that follow: direction in 0…1, strength
    vec3 sheen_color;
    float sheen_roughness;
    float iridescence;
    float film_thickness;
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
    t.anisotropy = vec3(1.0f, 0.5f, 1.0f);
    t.sheen_color = vec3(1.0f);
    t.sheen_roughness = 1.0f;
    t.iridescence = 1.0f;
    t.film_thickness = 1.0f;
    return t;
}

/// Coverage in [0, 1]: `alpha` is the base colour texel's times the vertex colour's.
SHADING_FN float material_opacity(SHADING_IN(MaterialData) m, float alpha) {
    float opacity = m.opacity * alpha;
    if ((m.flags & material_flag_alpha_mask) != 0u) {
        return opacity >= m.alpha_cutoff ? 1.0f : 0.0f;
    }
    return (m.flags & material_flag_alpha_blend) != 0u ? clamp(opacity, 0.0f, 1.0f) : 1.0f;
}

/// What extended materials add, as their glTF extensions say. Surface::tangent is in the tangent's own frame yet
/// (orient_tangent).
SHADING_FN void combine_extended(SHADING_IN(MaterialData) m, SHADING_IN(MaterialTexels) t, SHADING_INOUT(Surface) s) {
    s.thin_walled = (m.flags & material_flag_thin_walled) != 0u;
    s.conductor = m.model == material_model_conductor;
    s.anisotropy = clamp(m.anisotropy * t.anisotropy.z, 0.0f, 1.0f);
    // The texture's direction, turned by the material's angle.
    vec2 direction = vec2(t.anisotropy.x, t.anisotropy.y) * 2.0f - vec2(1.0f);
    s.tangent = vec3(direction.x * m.anisotropy_axis.x - direction.y * m.anisotropy_axis.y,
                     direction.x * m.anisotropy_axis.y + direction.y * m.anisotropy_axis.x, 0.0f);
    s.sheen_color = m.sheen_color * t.sheen_color;
    s.sheen_roughness = m.sheen_roughness * t.sheen_roughness;
    s.film_ior = m.film_ior;
    s.film_thickness_nm = mix(m.film_thinnest_nm, m.film_thickness_nm, t.film_thickness);
    s.iridescence = s.film_thickness_nm > 0.0f ? clamp(m.iridescence * t.iridescence, 0.0f, 1.0f) : 0.0f;
    s.eta = m.conductor_eta;
    s.k = m.conductor_k;
    s.conductor_average = m.conductor_average;
    s.subsurface = m.subsurface;
    s.specular_tint = m.specular_tint;
    s.sheen = m.sheen;
    s.sheen_tint = m.sheen_tint;
    s.clearcoat_gloss = m.clearcoat_gloss;
    s.sigma = m.sigma;
    s.absorption = s.thin_walled ? vec3(0.0f) : m.absorption;
}

/// glTF 2.0's products of factor, texel and vertex colour. `inside`: see Surface.
SHADING_FN MaterialPoint material_combine(SHADING_IN(MaterialData) m, SHADING_IN(MaterialTexels) t, vec4 vertex_color, bool inside) {
    MaterialPoint p;
    p.surface = surface_default();
    p.surface.base_color = m.base_color * vec3(t.base_color) * vec3(vertex_color);
    p.emission = m.emission_nits * t.emission;
    p.opacity = material_opacity(m, t.base_color.w * vertex_color.w);
    p.occlusion = 1.0f + m.occlusion_strength * (t.occlusion - 1.0f);
    if (m.model == material_model_lambert) {
        p.surface.model = m.model;
        return p;
    }
    p.surface.metallic = clamp(m.metallic * t.orm.z, 0.0f, 1.0f);
    p.surface.specular_color = m.specular_color * t.specular_color;
    p.surface.specular = clamp(m.specular * t.specular, 0.0f, 1.0f);
    p.surface.roughness = clamp(m.roughness * t.orm.y, 0.0f, 1.0f);
    p.surface.ior = m.ior;
    p.surface.transmission = clamp(m.transmission * t.transmission, 0.0f, 1.0f);
    p.surface.clearcoat = clamp(m.clearcoat * t.clearcoat, 0.0f, 1.0f);
    p.surface.clearcoat_roughness = clamp(m.clearcoat_roughness * t.clearcoat_roughness, 0.0f, 1.0f);
    // Those of one substance are the standard model's; what a pane reflects is a mirror's.
    bool standard = m.model == material_model_thin || m.model == material_model_conductor || m.model == material_model_dielectric;
    p.surface.model = standard ? material_model_standard : m.model;
    bool solid = m.model == material_model_standard || m.model == material_model_dielectric;
    p.surface.inside = inside && solid && p.surface.transmission > 0.0f;
    p.surface.extended = (m.flags & material_flag_extended) != 0u;
    if (is_extended(p.surface)) {
        combine_extended(m, t, p.surface);
        p.surface.inside = p.surface.inside && !p.surface.thin_walled;
    }
    if (m.model == material_model_unlit) {
        p.emission = p.emission * p.surface.base_color;
    }
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

/// Turns Surface::tangent from the frame of the mesh's `tangent` (world, w its handedness) to the world; `n` is on the
/// front side. Where there is no tangent, any direction has to do.
SHADING_FN void orient_tangent(vec3 n, vec4 tangent, SHADING_INOUT(Surface) s) {
    vec3 t = vec3(tangent) - n * dot(n, vec3(tangent));
    float squared = dot(t, t);
    if (squared < 1.0e-12f) {
        s.tangent = vec3(0.0f);
        return;
    }
    t = t * inversesqrt(squared);
    s.tangent = t * s.tangent.x + cross(n, t) * (tangent.w * s.tangent.y);
}
/// The local frame of a surface about the shading normal `n`.
SHADING_FN Frame surface_frame(SHADING_IN(Surface) s, vec3 n) {
    Frame frame = frame_from_normal(n);
    if (is_extended(s)) {
        vec3 t = s.tangent - n * dot(n, s.tangent);
        float squared = dot(t, t);
        if (squared > 1.0e-12f) {
            frame.tangent = t * inversesqrt(squared);
            frame.bitangent = cross(n, frame.tangent);
        }
    }
    return frame;
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
