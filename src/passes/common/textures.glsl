// Bindless textures: every slot is filled (with a white texel where the scene has none).
#ifndef HELIODON_TEXTURES_GLSL
#define HELIODON_TEXTURES_GLSL
#extension GL_EXT_nonuniform_qualifier : require

#include "shading/scene_data.h"

layout(set = 1, binding = 0) uniform sampler2D textures[];

vec2 transform_texcoord(TextureRef use, vec2 texcoord) {
    return mat2(use.uv_matrix.xy, use.uv_matrix.zw) * texcoord + use.uv_offset;
}

#endif
