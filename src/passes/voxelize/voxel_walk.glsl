// Calls visit(triangle, voxel) for the voxels that each triangle may pass through: an invocation takes a small
// triangle, a workgroup sixty-four columns of a large one. The includer defines visit() and, as `header` and `push`,
// the numbering and the constants.
#ifndef HELIODON_VOXEL_WALK_GLSL
#define HELIODON_VOXEL_WALK_GLSL
#include "passes/voxelize/linear_groups.glsl"
#include "passes/voxelize/voxel_triangle.glsl"

layout(constant_id = 0) const bool tiles_alone = false;
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

bool find_triangle(out VoxelTriangle triangle) {
    const uint number = linear_invocation();
    if (number >= push.triangle_count) return false;
    const TriangleRange range = range_of(number);
    return load_triangle(push.grid, range.instance, number - range.first_triangle, triangle);
}

bool is_small(VoxelTriangle triangle) {
    const uvec3 span = uvec3(triangle.high - triangle.low + 1);
    return span.x * span.y * span.z <= small_triangle_voxels;
}

void walk_box(VoxelTriangle triangle) {
    // A voxel whose centre is farther from the plane than its half diagonal along the normal is not crossed; the
    // slack is for rounding.
    const float reach = 0.5f * (abs(triangle.normal.x) + abs(triangle.normal.y) + abs(triangle.normal.z)) + 1.0e-3f;
    for (int z = triangle.low.z; z <= triangle.high.z; ++z)
        for (int y = triangle.low.y; y <= triangle.high.y; ++y)
            for (int x = triangle.low.x; x <= triangle.high.x; ++x)
                if (abs(dot(triangle.normal, vec3(x, y, z) + 0.5f - triangle.p0)) <= reach) visit(triangle, ivec3(x, y, z));
}

void walk_tile(VoxelTile tile) {
    VoxelTriangle triangle;
    if (!load_triangle(push.grid, tile.instance, tile.primitive, triangle)) return;
    const int axis = dominant_axis(triangle.normal);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const ivec2 column = ivec2(tile.column_u + gl_LocalInvocationID.x % voxel_tile_edge,
                               tile.column_v + gl_LocalInvocationID.x / voxel_tile_edge);
    if (column.x > triangle.high[u] || column.y > triangle.high[v]) return;
    const ivec2 depth = voxels_in_column(triangle, axis, column);
    for (int w = depth.x; w <= depth.y; ++w) {
        ivec3 voxel;
        voxel[axis] = w;
        voxel[u] = column.x;
        voxel[v] = column.y;
        visit(triangle, voxel);
    }
}

#endif
