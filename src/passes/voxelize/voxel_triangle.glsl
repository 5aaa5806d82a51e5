// A triangle of the scene in the voxel grid's space, where a voxel's edge is 1.
#ifndef HELIODON_VOXEL_TRIANGLE_GLSL
#define HELIODON_VOXEL_TRIANGLE_GLSL
#include "passes/common/scene_tables.glsl"
#include "passes/voxelize/voxel_shared.h"

layout(push_constant) uniform Push { VoxelizeConstants push; };

struct VoxelTriangle {
    uint instance;
    uint primitive;
    vec3 p0;
    vec3 p1;
    vec3 p2;
    vec3 normal;  // unit, of the front
    ivec3 low;    // the voxels of the grid that its box reaches: first and last
    ivec3 high;
};

vec3 grid_position(InstanceData instance, GeometryData geometry, uint vertex) {
    const vec3 world = vec3(instance.object_to_world * vec4(fetch_vec3(geometry.position_offset, vertex), 1.0f));
    vec3 position = (world - push.grid.origin) / push.grid.voxel_m;
    if (push.grid.snap > 0.0f) position = floor(position / push.grid.snap + 0.5f) * push.grid.snap;
    return position - vec3(push.grid.base);
}

/// Whether the voxels from `low` to `high` were carried from another grid with all that triangles bring.
bool carried(ivec3 low, ivec3 high) {
    return push.entered_only != 0u && all(greaterThanEqual(low + push.shift, ivec3(0))) &&
           all(lessThan(high + push.shift, ivec3(int(push.grid.size))));
}

/// False where it has no area, lies outside the grid or was carried. Surfaces in the plane between two voxels belong to
/// the upper one; those in the last plane of a grid that does not move, to the last voxel.
bool triangle_in_grid(vec3 p0, vec3 p1, vec3 p2, float determinant_sign, inout VoxelTriangle triangle) {
    triangle.p0 = p0;
    triangle.p1 = p1;
    triangle.p2 = p2;
    const vec3 low = min(p0, min(p1, p2));
    const vec3 high = max(p0, max(p1, p2));
    const float size = float(push.grid.size);
    if (!(all(greaterThanEqual(high, vec3(0.0f))) && all(lessThanEqual(low, vec3(size))))) return false;
    if (push.grid.snap > 0.0f && any(equal(low, vec3(size)))) return false;
    triangle.low = ivec3(clamp(floor(low), vec3(0.0f), vec3(size - 1.0f)));
    triangle.high = ivec3(clamp(floor(high), vec3(0.0f), vec3(size - 1.0f)));
    if (carried(triangle.low, triangle.high)) return false;
    const vec3 normal = cross(p1 - p0, p2 - p0);
    const float twice_area = length(normal);
    if (!(twice_area > 0.0f)) return false;
    triangle.normal = normal * (determinant_sign / twice_area);
    return true;
}

uvec3 triangle_index(GeometryData geometry, uint primitive) {
    const uint first = geometry.first_index + 3u * primitive;
    return uvec3(index_table[first], index_table[first + 1u], index_table[first + 2u]);
}

bool load_triangle(uint instance_index, uint primitive, out VoxelTriangle triangle) {
    const InstanceData instance = instance_table[instance_index];
    const GeometryData geometry = geometry_table[instance.geometry];
    const uvec3 index = triangle_index(geometry, primitive);
    triangle.instance = instance_index;
    triangle.primitive = primitive;
    return triangle_in_grid(grid_position(instance, geometry, index.x), grid_position(instance, geometry, index.y),
                            grid_position(instance, geometry, index.z), instance.determinant_sign, triangle);
}

/// Where the voxel stands in voxel_number[].
uint voxel_place(ivec3 voxel) { return uint(voxel.x) + push.grid.size * (uint(voxel.y) + push.grid.size * uint(voxel.z)); }

/// The axis along which the triangle is seen largest.
int dominant_axis(vec3 normal) {
    const vec3 n = abs(normal);
    return n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
}

/// First and last voxel along `axis` (the dominant one) that the triangle's plane crosses in a column of voxels.
/// At most three, but for rounding.
ivec2 voxels_in_column(VoxelTriangle triangle, int axis, ivec2 column) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const vec2 slope = vec2(triangle.normal[u], triangle.normal[v]) / triangle.normal[axis];
    const vec2 from = vec2(column) + 0.5f - vec2(triangle.p0[u], triangle.p0[v]);
    const float depth = triangle.p0[axis] - dot(slope, from);
    // Sixteen roundings of single precision are more than went into `depth`.
    const float rounding = exp2(-20.0f) * (abs(triangle.p0[axis]) + abs(from.x) + abs(from.y) + 1.0f);
    const float reach = 0.5f * (abs(slope.x) + abs(slope.y)) + rounding;
    const vec2 bounds = clamp(floor(vec2(depth - reach, depth + reach)), -1.0f, float(triangle.high[axis]) + 1.0f);
    return ivec2(max(int(bounds.x), triangle.low[axis]), min(int(bounds.y), triangle.high[axis]));
}

/// Leaves of the triangle's box the part in a column, (axis + 1) % 3 and (axis + 2) % 3 along; false if none is left.
bool narrow_to_column(inout VoxelTriangle triangle, ivec2 column) {
    const int axis = dominant_axis(triangle.normal);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    if (column.x < triangle.low[u] || column.x > triangle.high[u] || column.y < triangle.low[v] || column.y > triangle.high[v]) return false;
    const ivec2 depth = voxels_in_column(triangle, axis, column);
    triangle.low[axis] = depth.x;
    triangle.high[axis] = depth.y;
    triangle.low[u] = triangle.high[u] = column.x;
    triangle.low[v] = triangle.high[v] = column.y;
    return depth.x <= depth.y;
}

/// The box's voxels one after the other, from `low`; false after the last.
bool next_voxel(VoxelTriangle triangle, inout ivec3 voxel) {
    if (++voxel.x <= triangle.high.x) return true;
    voxel.x = triangle.low.x;
    if (++voxel.y <= triangle.high.y) return true;
    voxel.y = triangle.low.y;
    return ++voxel.z <= triangle.high.z;
}

/// Whether the triangle's plane passes a voxel no farther from its centre than the voxel's half diagonal along the
/// normal; a little farther, for rounding. Not in voxels that are carried.
bool near_plane(VoxelTriangle triangle, ivec3 voxel) {
    if (carried(voxel, voxel)) return false;
    const float reach = 0.5f * (abs(triangle.normal.x) + abs(triangle.normal.y) + abs(triangle.normal.z));
    return abs(dot(triangle.normal, vec3(voxel) + 0.5f - triangle.p0)) <= reach + 1.0e-3f;
}

#endif
