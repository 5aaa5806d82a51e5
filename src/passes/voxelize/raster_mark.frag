#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers the voxels that a triangle passes through in a pixel's column.
#include "passes/voxelize/voxel_mark.glsl"
#include "passes/voxelize/voxel_column.glsl"

void main() {
    VoxelTriangle triangle;
    if (!column_of_fragment(triangle)) return;
    ivec3 voxel = triangle.low;
    do {
        if (near_plane(triangle, voxel) && is_first(triangle, voxel))
            number_voxel(voxel_place(voxel), atomicAdd(header.record_demand, 1u));
    } while (next_voxel(triangle, voxel));
}
