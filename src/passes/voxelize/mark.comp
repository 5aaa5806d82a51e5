#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers the voxels of small triangles and lists the tiles of large ones; then, run over the tiles, numbers theirs.
#include "passes/voxelize/voxel_mark.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 19, std430) buffer Tiles { VoxelTile tiles[]; };
#include "passes/voxelize/voxel_walk.glsl"

/// The triangle's edges as seen along its dominant axis: xy towards its inside, dot(xy, position) ≥ z there.
vec3 inward_edge(vec2 a, vec2 b, float turn) {
    const vec2 inward = vec2(a.y - b.y, b.x - a.x) * turn;
    return vec3(inward, dot(inward, a));
}
/// Whether a square of columns from `low` can meet it. Half a voxel wider all round, for rounding.
bool meets(vec3 edge, vec2 low) {
    const float half_edge = 0.5f * float(voxel_tile_edge);
    return dot(edge.xy, low + half_edge) + (half_edge + 0.5f) * (abs(edge.x) + abs(edge.y)) >= edge.z;
}

void list_tiles(VoxelTriangle triangle) {
    const int axis = dominant_axis(triangle.normal);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const vec2 a = vec2(triangle.p0[u], triangle.p0[v]);
    const vec2 b = vec2(triangle.p1[u], triangle.p1[v]);
    const vec2 c = vec2(triangle.p2[u], triangle.p2[v]);
    const float turn = determinant(mat2(b - a, c - a)) < 0.0f ? -1.0f : 1.0f;
    const vec3 ab = inward_edge(a, b, turn);
    const vec3 bc = inward_edge(b, c, turn);
    const vec3 ca = inward_edge(c, a, turn);
    uint first = 0u;
    uint count = 0u;
    // Counted, then written: one atomic operation makes room for all.
    for (int writing = 0; writing < 2; ++writing) {
        if (writing == 1) first = atomicAdd(header.tile_demand, count);
        count = 0u;
        for (int y = triangle.low[v]; y <= triangle.high[v]; y += int(voxel_tile_edge))
            for (int x = triangle.low[u]; x <= triangle.high[u]; x += int(voxel_tile_edge)) {
                const vec2 low = vec2(x, y);
                if (!meets(ab, low) || !meets(bc, low) || !meets(ca, low)) continue;
                const uint place = first + count++;
                if (writing == 1 && place < push.tile_capacity)
                    tiles[place] = VoxelTile(triangle.instance, triangle.primitive, uint(x), uint(y));
            }
    }
}

void main() {
    VoxelTriangle triangle;
    const bool large = push.over_tiles != 0u;
    if (large ? !find_column(triangle) : !find_triangle(triangle)) return;
    if (!large && !is_small(triangle)) {
        list_tiles(triangle);
        return;
    }
    ivec3 voxel = triangle.low;
    do {
        if (near_plane(triangle, voxel)) mark(triangle, voxel);
    } while (next_voxel(triangle, voxel));
}
