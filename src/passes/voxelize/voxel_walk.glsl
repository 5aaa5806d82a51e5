// The voxels that each triangle may pass through: an invocation takes a small triangle, a workgroup sixty-four columns
// of a large one. The includer defines `header`, `tiles` and `push`.
#ifndef HELIODON_VOXEL_WALK_GLSL
#define HELIODON_VOXEL_WALK_GLSL
#include "passes/voxelize/linear_groups.glsl"
#include "passes/voxelize/voxel_triangle.glsl"

struct TriangleRange {
    uint first_triangle;
    uint instance;
};
layout(set = 0, binding = 12, std430) readonly buffer Ranges { TriangleRange ranges[]; };

/// The range that a triangle of all ranges together lies in.
TriangleRange range_of(uint triangle) {
    uint low = 0u;
    uint high = push.range_count;
    while (high - low > 1u) {
        const uint middle = (low + high) / 2u;
        if (ranges[middle].first_triangle <= triangle) low = middle;
        else high = middle;
    }
    return ranges[low];
}

bool is_small(VoxelTriangle triangle) {
    const uvec3 span = uvec3(triangle.high - triangle.low + 1);
    return span.x * span.y * span.z <= small_triangle_voxels;
}

/// This invocation's triangle of all; false if there is none.
bool find_triangle(out VoxelTriangle triangle) {
    const uint number = linear_invocation();
    if (number >= push.triangle_count) return false;
    const TriangleRange range = range_of(number);
    return load_triangle(push.grid, range.instance, number - range.first_triangle, triangle);
}

/// The triangle of this workgroup's tile, and instead of its box the part of it in this invocation's column.
bool find_column(out VoxelTriangle triangle) {
    const uint number = linear_group();
    if (number >= header.tile_count) return false;
    const VoxelTile tile = tiles[number];
    if (!load_triangle(push.grid, tile.instance, tile.primitive, triangle)) return false;
    const int axis = dominant_axis(triangle.normal);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const ivec2 column = ivec2(tile.column_u + gl_LocalInvocationID.x % voxel_tile_edge,
                               tile.column_v + gl_LocalInvocationID.x / voxel_tile_edge);
    if (column.x > triangle.high[u] || column.y > triangle.high[v]) return false;
    const ivec2 depth = voxels_in_column(triangle, axis, column);
    triangle.low[axis] = depth.x;
    triangle.high[axis] = depth.y;
    triangle.low[u] = triangle.high[u] = column.x;
    triangle.low[v] = triangle.high[v] = column.y;
    return true;
}

bool next_voxel(VoxelTriangle triangle, inout ivec3 voxel) {
    if (++voxel.x <= triangle.high.x) return true;
    voxel.x = triangle.low.x;
    if (++voxel.y <= triangle.high.y) return true;
    voxel.y = triangle.low.y;
    return ++voxel.z <= triangle.high.z;
}

/// Whether the triangle's plane passes a voxel no farther from its centre than the voxel's half diagonal along the
/// normal; a little farther, for rounding.
bool near_plane(VoxelTriangle triangle, ivec3 voxel) {
    const float reach = 0.5f * (abs(triangle.normal.x) + abs(triangle.normal.y) + abs(triangle.normal.z));
    return abs(dot(triangle.normal, vec3(voxel) + 0.5f - triangle.p0)) <= reach + 1.0e-3f;
}

#endif
