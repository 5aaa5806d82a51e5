#version 460
#extension GL_GOOGLE_include_directive : require
// Finds the voxels that were there before surfaces were voxelized anew: they keep the light that they gathered.
#include "passes/inject/inject_shared.h"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, std430) readonly buffer KeptNumbers { VoxelHeader kept; };
layout(set = 0, binding = 17, std430) readonly buffer KeptCells { uint kept_cell[]; };
layout(set = 0, binding = 18, std430) readonly buffer Numbers { VoxelHeader header; uint voxel_number[]; };
layout(set = 0, binding = 19, std430) writeonly buffer Sources { uint source[]; };  // by record: 0, or 1 + the kept one
layout(push_constant) uniform Push { InjectConstants push; };

void main() {
    const uint from = linear_invocation();
    if (from >= kept.record_count) return;
    const int size = int(push.grid.size);
    const int cell = int(kept_cell[from]);
    const ivec3 voxel = ivec3(cell % size, cell / size % size, cell / (size * size)) - push.shift;
    if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, ivec3(size)))) return;
    const uint number = voxel_number[voxel.x + size * (voxel.y + size * voxel.z)];
    if (number != 0u && number != voxel_without_room) source[number - 1u] = from + 1u;
}
