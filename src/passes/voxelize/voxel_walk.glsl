// The voxels that each triangle may pass through: an invocation takes a small triangle, a workgroup sixty-four columns
// of a large one. The includer defines `header` and `tiles`.
#ifndef HELIODON_VOXEL_WALK_GLSL
#define HELIODON_VOXEL_WALK_GLSL
#include "passes/voxelize/linear_groups.glsl"
#include "passes/voxelize/voxel_ranges.glsl"
#include "passes/voxelize/voxel_triangle.glsl"

bool is_small(VoxelTriangle triangle) {
    const uvec3 span = uvec3(triangle.high - triangle.low + 1);
    return span.x * span.y * span.z <= small_triangle_voxels;
}

/// A triangle of all; false if there is none.
bool find_triangle(uint number, out VoxelTriangle triangle) {
    if (number >= push.triangle_count) return false;
    const TriangleRange range = range_of(number, push.range_count);
    return load_triangle(range.instance, number - range.first_triangle, triangle);
}

/// The triangle of a tile, and instead of its box the part of it in this invocation's column.
bool find_column(uint number, out VoxelTriangle triangle) {
    if (number >= header.tile_count) return false;
    const VoxelTile tile = tiles[number];
    if (!load_triangle(tile.instance, tile.primitive, triangle)) return false;
    const ivec2 column = ivec2(tile.column_u + gl_LocalInvocationID.x % voxel_tile_edge,
                               tile.column_v + gl_LocalInvocationID.x / voxel_tile_edge);
    return narrow_to_column(triangle, column);
}

#endif
