// What an alpha test needs at a raster fragment, before there is a resolved surface.
#ifndef HELIODON_ALPHA_GLSL
#define HELIODON_ALPHA_GLSL
#include "passes/common/scene_tables.glsl"
#include "passes/common/hash.glsl"
#include "passes/common/textures.glsl"

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

/// Of the chance by which a blended surface stands in a texel of a shadow map.
uint alpha_seed(uvec2 texel, uint instance, uint random_seed) {
    return pcg_hash(texel.x + pcg_hash(texel.y + pcg_hash(instance + pcg_hash(random_seed))));
}

#endif
