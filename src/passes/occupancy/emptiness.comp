#version 460
#extension GL_GOOGLE_include_directive : require
// How many levels are empty about each voxel of a cascade: four voxels along x an invocation.
#include "passes/occupancy/occupancy_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std430) readonly buffer Occupancy { uint occupancy[]; };
layout(set = 0, binding = 1, std430) buffer Emptiness { uint emptiness[]; };
layout(push_constant) uniform Push { EmptinessConstants push; };

const uint faces = 0x3fu;

uint texel_index(uvec3 texel, uint size) { return texel.x + size * (texel.y + size * texel.z); }

/// A bit each of six into four each: 49₁₆ = 1 + 2³ + 2⁶ moves the lowest three apart.
uint spread(uint bits) { return ((bits & 7u) * 0x49u & 0x111u) | ((bits >> 3u) * 0x49u & 0x111u) << 12u; }

/// The widest cascade's levels, the finest first, as long as they are empty.
uvec4 empty_levels(uvec3 voxel) {
    uvec4 counts = uvec4(0u);
    uvec4 empty = uvec4(faces);
    for (uint level = 0u; (push.size >> level) >= fewest_occupancy_texels; ++level) {
        const uint size = push.size >> level;
        const uint first = occupancy_first(push.size, push.cascade, level);
        for (uint i = 0u; i < 4u; ++i) {
            const uint byte = texel_index((voxel + uvec3(i, 0u, 0u)) >> level, size);
            empty[i] &= ~(occupancy[first + byte / 4u] >> 8u * (byte & 3u));
            counts[i] += spread(empty[i]);
        }
    }
    return counts;
}

/// What is empty here is as far empty as the next cascade's voxel about it, and one level more.
uvec4 empty_cascades(uvec3 voxel) {
    const uint cells = push.size * push.size * push.size;
    const uint bytes = occupancy[occupancy_first(push.size, push.cascade, 0u) + texel_index(voxel, push.size) / 4u];
    uvec4 counts;
    for (uint i = 0u; i < 4u; ++i) {
        const ivec3 outer = (ivec3(voxel + uvec3(i, 0u, 0u)) + push.base >> 1) - push.outer_base;
        const uint onward = emptiness[(push.cascade + 1u) * cells + texel_index(uvec3(clamp(outer, ivec3(0), ivec3(push.size - 1u))), push.size)];
        const uint empty = spread(~(bytes >> 8u * i) & faces);
        counts[i] = (onward & empty * 15u) + empty;
    }
    return counts;
}

void main() {
    const uvec3 voxel = gl_GlobalInvocationID * uvec3(4u, 1u, 1u);
    if (any(greaterThanEqual(voxel, uvec3(push.size)))) return;
    const uvec4 counts = push.widest != 0u ? empty_levels(voxel) : empty_cascades(voxel);
    const uint first = push.cascade * push.size * push.size * push.size + texel_index(voxel, push.size);
    for (uint i = 0u; i < 4u; ++i) emptiness[first + i] = counts[i];
}
