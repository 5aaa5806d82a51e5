// Numbers the voxels that surfaces pass through. The numbers depend on who comes first; no sum depends on them.
#ifndef HELIODON_VOXEL_MARK_GLSL
#define HELIODON_VOXEL_MARK_GLSL
#include "passes/voxelize/clip.glsl"
#include "passes/voxelize/voxel_triangle.glsl"

layout(set = 0, binding = 16, std430) buffer Numbers { VoxelHeader header; uint voxel_number[]; };
layout(set = 0, binding = 17, std430) writeonly buffer Cells { uint record_cell[]; };

/// Whether the triangle is the first to pass through the voxel: then a record has to be numbered.
bool is_first(VoxelTriangle triangle, ivec3 voxel) {
    const uint place = voxel_place(voxel);
    return voxel_number[place] == 0u && centroid_and_area(triangle.p0, triangle.p1, triangle.p2, vec3(voxel)).w > 0.0f &&
           atomicCompSwap(voxel_number[place], 0u, voxel_without_room) == 0u;
}

void number_voxel(uint place, uint record) {
    if (record >= push.record_capacity) return;
    record_cell[record] = place;
    voxel_number[place] = record + 1u;
}

#endif
