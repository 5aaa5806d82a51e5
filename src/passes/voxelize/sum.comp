#version 460
#extension GL_GOOGLE_include_directive : require
// Sums the records: of small triangles, or of the tiles of large ones.
#include "passes/voxelize/voxel_sum.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 19, std430) readonly buffer Tiles { VoxelTile tiles[]; };
#include "passes/voxelize/voxel_walk.glsl"

void main() {
    VoxelTriangle triangle;
    const bool large = push.over_tiles != 0u;
    if (large ? !find_column(triangle) : !find_triangle(triangle)) return;
    if (!large && !is_small(triangle)) return;
    ivec3 voxel = triangle.low;
    do {
        if (near_plane(triangle, voxel)) sum(triangle, voxel);
    } while (next_voxel(triangle, voxel));
}
