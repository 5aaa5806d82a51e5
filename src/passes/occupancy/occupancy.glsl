// Sets the bits of a voxel and of those beside it.
#ifndef HELIODON_OCCUPANCY_GLSL
#define HELIODON_OCCUPANCY_GLSL
#include "passes/occupancy/occupancy_shared.h"

layout(set = 0, binding = 20, rgba16f) uniform readonly image3D faces;
layout(set = 0, binding = 23, std430) buffer Occupancy { uint occupancy[]; };

/// Of a texture with `size` texels an edge a face.
uint occupied_faces(ivec3 voxel, uint size, uint cascade) {
    uint bits = 0u;
    for (int face = 0; face < 6; ++face)
        if (imageLoad(faces, voxel + int(size) * ivec3(face & 1, int(cascade), face >> 1)).a != 0.0f) bits |= 1u << face;
    return bits;
}

void mark_occupied(ivec3 voxel, uint bits, uint size, uint first) {
    for (int i = 0; i < 27; ++i) {
        const ivec3 offset = ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        const ivec3 at = voxel + offset;
        if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, ivec3(size)))) continue;
        // Interpolation mixes texels across a face's axis, not along it.
        const uint mixed = bits & ~((offset.x != 0 ? 3u : 0u) | (offset.y != 0 ? 12u : 0u) | (offset.z != 0 ? 48u : 0u));
        const uint word = first + uint(at.x + int(size) * (at.y + int(size) * at.z)) / 4u;
        const uint wanted = mixed << 8u * (uint(at.x) & 3u);
        if ((occupancy[word] & wanted) != wanted) atomicOr(occupancy[word], wanted);
    }
}

#endif
