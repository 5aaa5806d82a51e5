#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/compute_raster/resolve.glsl"

layout(set = 0, binding = 15) uniform writeonly image2DArray shadow_depth;
layout(set = 0, binding = 16) uniform writeonly image2DArray shadow_slope;

void resolve(uvec2 key, ivec3 texel) {
    imageStore(shadow_depth, texel, vec4(uintBitsToFloat(key.y), 0.0f, 0.0f, 0.0f));
    imageStore(shadow_slope, texel, vec4(unpackHalf2x16(key.x), 0.0f, 0.0f));
}
