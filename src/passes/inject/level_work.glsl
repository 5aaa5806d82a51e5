// One invocation an occupied voxel of a coarse level.
#ifndef HELIODON_LEVEL_WORK_GLSL
#define HELIODON_LEVEL_WORK_GLSL
#include "passes/inject/inject_shared.h"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, std430) readonly buffer Levels { VoxelLevelsHeader levels_header; uint level_voxels[]; };
layout(push_constant) uniform Push { FilterConstants push; };

bool level_voxel(out ivec3 voxel, out int size) {
    const uint index = linear_invocation();
    size = int(push.size >> push.level);
    if (index >= levels_header.groups[push.level].w) return false;
    const int cell = int(level_voxels[push.list_first + index]);
    voxel = ivec3(cell % size, cell / size % size, cell / (size * size));
    return true;
}

/// First texel of a face in the texture of all faces.
ivec3 face_corner(int axis, int side, int size) { return size * ivec3(side, int(push.cascade), axis); }

/// Of two voxels behind each other, by their covers: the share of the rear one that is seen past the front one, pieces of one
/// surface side by side (docs/gi-theory.md).
float seen_behind(float front, float rear) { return rear > 0.0f ? min(1.0f - front, rear) / rear : 0.0f; }

#endif
