#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/compute_raster/resolve.glsl"
#include "passes/voxelize/voxel_ranges.glsl"

layout(set = 0, binding = 15) uniform writeonly uimage2D visibility;  // instance + 1 (0: background), triangle
layout(set = 0, binding = 16) uniform writeonly image2D depth;

void resolve(uvec2 key, ivec3 pixel) {
    uvec2 visible = uvec2(0u);
    if (key.y != 0u) {
        const TriangleRange range = range_of(~key.x, push.range_count);
        visible = uvec2(range.instance + 1u, ~key.x - range.first_triangle);
    }
    imageStore(visibility, pixel.xy, uvec4(visible, 0u, 0u));
    imageStore(depth, pixel.xy, vec4(uintBitsToFloat(key.y), 0.0f, 0.0f, 0.0f));
}
