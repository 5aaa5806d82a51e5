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

#endif
