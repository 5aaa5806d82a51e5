#version 460
#extension GL_GOOGLE_include_directive : require
// Sums the records that a triangle passes through in a pixel's column.
#include "passes/voxelize/voxel_sum.glsl"
#include "passes/voxelize/voxel_column.glsl"

void main() {
    VoxelTriangle triangle;
    if (!column_of_fragment(triangle)) return;
    ivec3 voxel = triangle.low;
    do {
        if (near_plane(triangle, voxel)) sum(triangle, voxel);
    } while (next_voxel(triangle, voxel));
}
