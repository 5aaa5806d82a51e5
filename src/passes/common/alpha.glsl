// What an alpha test needs at a raster fragment, before there is a resolved surface.
#ifndef HELIODON_ALPHA_GLSL
#define HELIODON_ALPHA_GLSL
#include "passes/common/scene_tables.glsl"
#include "passes/common/hash.glsl"
#include "passes/common/textures.glsl"
#include "shading/pane.h"

/// Opacity of a material at a texture coordinate: factor × vertex alpha × base colour texture's alpha.
float surface_opacity(MaterialData material, vec2 texcoord, float vertex_alpha) {
    float opacity = material.opacity * vertex_alpha;
    const TextureRef use = material.base_color_texture;
    if (use.texture_index != no_texture)
        opacity *= texture(textures[nonuniformEXT(use.texture_index)], transform_texcoord(use, texcoord)).a;
    return opacity;
}
/// The same where no neighbours are shaded: the coordinate's change from pixel to pixel is given.
float surface_opacity_within(MaterialData material, vec2 texcoord, vec2 texcoord_dx, vec2 texcoord_dy, float vertex_alpha) {
    float opacity = material.opacity * vertex_alpha;
    const TextureRef use = material.base_color_texture;
    if (use.texture_index == no_texture) return opacity;
    const mat2 uv_matrix = mat2(use.uv_matrix.xy, use.uv_matrix.zw);
    return opacity * textureGrad(textures[nonuniformEXT(use.texture_index)], transform_texcoord(use, texcoord), uv_matrix * texcoord_dx,
                                 uv_matrix * texcoord_dy).a;
}

/// What a pane keeps back of the light that passes a view's normalized device coordinates `at`; any length of normal.
float pane_cover(MaterialData material, mat4 world_to_clip, vec2 at, vec3 normal) {
    const mat4 rows = transpose(world_to_clip);
    const vec3 ray = cross(rows[0].xyz - at.x * rows[3].xyz, rows[1].xyz - at.y * rows[3].xyz);
    return 1.0f - thin_transmittance(material, dot(normalize(ray), normalize(normal)));
}

/// Of the chance by which a blended surface stands in a texel of a shadow map.
uint alpha_seed(uvec2 texel, uint instance, uint random_seed) {
    return pcg_hash(texel.x + pcg_hash(texel.y + pcg_hash(instance + pcg_hash(random_seed))));
}

#endif
