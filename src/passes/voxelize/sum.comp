#version 460
#extension GL_GOOGLE_include_directive : require
// Sums the records: of small triangles, or of the tiles of large ones.
#include "passes/voxelize/voxel_sum.glsl"
#include "passes/voxelize/voxel_walk.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 19, std430) readonly buffer Tiles { VoxelTile tiles[]; };

void main() {
    if (tiles_alone) {
        const uint tile = linear_group();
        if (tile < header.tile_count) walk_tile(tiles[tile]);
        return;
    }
    VoxelTriangle triangle;
    if (find_triangle(triangle) && is_small(triangle)) walk_box(triangle);
}
