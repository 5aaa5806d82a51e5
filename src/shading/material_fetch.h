// The texture fetches of a material, through the includer. Opens no namespace and has no include guard:
// GLSL includes it at global scope, C++ inside the struct whose members answer the fetches (in a
// namespace with `using namespace heliodon::shading`, after including shading/material_eval.h outside).
//
// The includer has defined, before this point (in GLSL) or anywhere in the struct (in C++):
//   vec4 scene_texture(uint texture_index, vec2 uv)  filtered and wrapped, sRGB formats decoded; the
//                                                    level of detail is the includer's own state
//   vec2 scene_texture_size(uint texture_index)      texels of level 0

SHADING_FN vec2 texture_uv(SHADING_IN(TextureRef) ref, vec2 uv0, vec2 uv1) {
    vec2 uv = ref.texcoord == 0u ? uv0 : uv1;
    return vec2(ref.uv_matrix.x * uv.x + ref.uv_matrix.z * uv.y, ref.uv_matrix.y * uv.x + ref.uv_matrix.w * uv.y) +
           ref.uv_offset;
}
SHADING_FN vec4 fetch_or_one(SHADING_IN(TextureRef) ref, vec2 uv0, vec2 uv1) {
    if (ref.texture_index == no_texture) {
        return vec4(1.0f);
    }
    return scene_texture(ref.texture_index, texture_uv(ref, uv0, uv1));
}

/// Coverage alone: for shadow rays and the first pass of masked surfaces.
SHADING_FN float material_opacity_at(SHADING_IN(MaterialData) m, vec2 uv0, vec2 uv1, float vertex_alpha) {
    if ((m.flags & (material_flag_alpha_mask | material_flag_alpha_blend)) == 0u) {
        return 1.0f;
    }
    return material_opacity(m, fetch_or_one(m.base_color_texture, uv0, uv1).w * vertex_alpha);
}

/// `uv0`, `uv1`: the two coordinate sets; `vertex_color` linear; `inside`: the ray meets the back side.
SHADING_FN MaterialPoint material_at(SHADING_IN(MaterialData) m, vec2 uv0, vec2 uv1, vec4 vertex_color, bool inside) {
    MaterialTexels t = material_texels_default();
    t.base_color = fetch_or_one(m.base_color_texture, uv0, uv1);
    t.occlusion = fetch_or_one(m.occlusion_texture, uv0, uv1).x;
    t.emission = vec3(fetch_or_one(m.emission_texture, uv0, uv1));
    if (m.model == material_model_lambert) {
        return material_combine(m, t, vertex_color, inside);
    }
    t.orm = vec3(fetch_or_one(m.orm_texture, uv0, uv1));
    t.transmission = fetch_or_one(m.transmission_texture, uv0, uv1).x;
    t.specular = fetch_or_one(m.specular_texture, uv0, uv1).w;
    t.specular_color = vec3(fetch_or_one(m.specular_color_texture, uv0, uv1));
    t.clearcoat = fetch_or_one(m.clearcoat_texture, uv0, uv1).x;
    t.clearcoat_roughness = fetch_or_one(m.clearcoat_roughness_texture, uv0, uv1).y;
    if (shading_extended && (m.flags & material_flag_extended) != 0u) {
        if (m.anisotropy_texture.texture_index != no_texture) {
            t.anisotropy = vec3(fetch_or_one(m.anisotropy_texture, uv0, uv1));
        }
        t.sheen_color = vec3(fetch_or_one(m.sheen_color_texture, uv0, uv1));
        t.sheen_roughness = fetch_or_one(m.sheen_roughness_texture, uv0, uv1).w;
        t.iridescence = fetch_or_one(m.iridescence_texture, uv0, uv1).x;
        t.film_thickness = fetch_or_one(m.film_thickness_texture, uv0, uv1).y;
    }
    return material_combine(m, t, vertex_color, inside);
}

/// The interpolated normal `n` (unit, world) after the normal map and the bump map. `tangent`: world,
/// w = handedness. dp_du, dp_dv: of the coordinate set that the bump texture uses (triangle_derivatives).
/// Still to be made usable for the viewer: usable_shading_normal.
SHADING_FN vec3 material_normal_at(SHADING_IN(MaterialData) m, vec2 uv0, vec2 uv1, vec3 n, vec4 tangent, vec3 dp_du, vec3 dp_dv) {
    vec3 result = n;
    if (m.normal_texture.texture_index != no_texture) {
        vec3 texel = vec3(scene_texture(m.normal_texture.texture_index, texture_uv(m.normal_texture, uv0, uv1)));
        result = perturb_normal_map(result, tangent, texel, m.normal_scale);
    }
    if (m.bump_texture.texture_index != no_texture) {
        // Forward differences over one texel along u and along v of the mesh's own coordinates.
        vec4 a = m.bump_texture.uv_matrix;
        vec2 size = max(scene_texture_size(m.bump_texture.texture_index), vec2(1.0f));
        float step_u = 1.0f / max(length(vec2(a.x * size.x, a.y * size.y)), 1.0e-6f);
        float step_v = 1.0f / max(length(vec2(a.z * size.x, a.w * size.y)), 1.0e-6f);
        vec2 du = vec2(step_u, 0.0f);
        vec2 dv = vec2(0.0f, step_v);
        float h = fetch_or_one(m.bump_texture, uv0, uv1).x;
        float h_u = fetch_or_one(m.bump_texture, uv0 + du, uv1 + du).x;
        float h_v = fetch_or_one(m.bump_texture, uv0 + dv, uv1 + dv).x;
        result = perturb_bump(result, dp_du, dp_dv, (h_u - h) * m.bump_scale_m / step_u,
                              (h_v - h) * m.bump_scale_m / step_v);
    }
    return result;
}
