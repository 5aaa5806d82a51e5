// Numbers the voxels that surfaces pass through. The numbers depend on who comes first; no sum depends on them.
#ifndef HELIODON_VOXEL_MARK_GLSL
#define HELIODON_VOXEL_MARK_GLSL
#include "passes/voxelize/clip.glsl"
#include "passes/voxelize/voxel_triangle.glsl"

layout(set = 0, binding = 16, std430) buffer Numbers { VoxelHeader header; uint voxel_number[]; };
layout(set = 0, binding = 17, std430) writeonly buffer Cells { uint record_cell[]; };

void mark(VoxelTriangle triangle, ivec3 voxel) {
    const uint size = push.grid.size;
    const uint place = uint(voxel.x) + size * (uint(voxel.y) + size * uint(voxel.z));
    if (voxel_number[place] != 0u) return;
    if (!(centroid_and_area(triangle.p0, triangle.p1, triangle.p2, vec3(voxel)).w > 0.0f)) return;
    if (atomicCompSwap(voxel_number[place], 0u, voxel_without_room) != 0u) return;
    const uint record = atomicAdd(header.record_demand, 1u);
    if (record >= push.record_capacity) return;
    record_cell[record] = place;
    voxel_number[place] = record + 1u;
}

#endif
