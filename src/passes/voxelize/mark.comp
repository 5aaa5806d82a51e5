#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers the voxels of small triangles and lists the tiles of large ones; then, run over the tiles, numbers theirs.
#include "passes/voxelize/voxel_mark.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 19, std430) buffer Tiles { VoxelTile tiles[]; };
#include "passes/voxelize/voxel_pieces.glsl"

shared uint new_voxel[most_pieces];
shared uint new_count;
shared uint first_record;
shared uint wide_count;
shared uint wide[piece_invocations];  // invocations whose triangle may have more tiles than there are invocations

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

/// The squares of columns of tiles that may meet a triangle.
struct TileSearch {
    vec3 edges[3];
    ivec2 low;    // column
    ivec2 count;  // of tiles
};
TileSearch search_of(VoxelTriangle triangle) {
    const int axis = dominant_axis(triangle.normal);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const vec2 a = vec2(triangle.p0[u], triangle.p0[v]);
    const vec2 b = vec2(triangle.p1[u], triangle.p1[v]);
    const vec2 c = vec2(triangle.p2[u], triangle.p2[v]);
    const float turn = determinant(mat2(b - a, c - a)) < 0.0f ? -1.0f : 1.0f;
    TileSearch search;
    search.edges[0] = inward_edge(a, b, turn);
    search.edges[1] = inward_edge(b, c, turn);
    search.edges[2] = inward_edge(c, a, turn);
    search.low = ivec2(triangle.low[u], triangle.low[v]);
    search.count = (ivec2(triangle.high[u], triangle.high[v]) - search.low) / int(voxel_tile_edge) + 1;
    return search;
}

/// Of the triangle's tiles that number `first` and each `step`th after it.
void list_tiles(VoxelTriangle triangle, TileSearch search, int first, int step) {
    uint place = 0u;
    uint count = 0u;
    // Counted, then written: one atomic operation makes room for all.
    for (int writing = 0; writing < 2; ++writing) {
        if (writing == 1 && count == 0u) return;
        if (writing == 1) place = atomicAdd(header.tile_demand, count);
        for (int i = first; i < search.count.x * search.count.y; i += step) {
            const ivec2 column = search.low + int(voxel_tile_edge) * ivec2(i % search.count.x, i / search.count.x);
            const vec2 low = vec2(column);
            if (!meets(search.edges[0], low) || !meets(search.edges[1], low) || !meets(search.edges[2], low)) continue;
            if (writing == 0) ++count;
            else if (place++ < push.tile_capacity)
                tiles[place - 1u] = VoxelTile(triangle.instance, triangle.primitive, uint(column.x), uint(column.y));
        }
    }
}

/// Numbers the voxels of the workgroup's triangles; to be called by all.
void mark_pieces(VoxelTriangle triangle, bool left) {
    const uint own = gl_LocalInvocationID.x;
    ivec3 voxel = triangle.low;
    do {
        begin_pieces();
        if (own == 0u) new_count = 0u;
        list_pieces(triangle, voxel, left);
        for (uint i = own; i < piece_count(); i += piece_invocations) {
            VoxelTriangle piece;
            const ivec3 at = find_piece(i, piece);
            if (is_first(piece, at)) new_voxel[atomicAdd(new_count, 1u)] = voxel_place(at);
        }
        barrier();
        if (own == 0u && new_count != 0u) first_record = atomicAdd(header.record_demand, new_count);
        barrier();
        for (uint i = own; i < new_count; i += piece_invocations) number_voxel(new_voxel[i], first_record + i);
    } while (unlisted != 0u);
}

void main() {
    VoxelTriangle triangle;
    if (push.over_tiles != 0u) {
        mark_pieces(triangle, find_column(linear_group(), triangle));
        return;
    }
    const bool found = find_triangle(linear_invocation(), triangle);
    const bool small = found && is_small(triangle);
    // Most small triangles lie wholly in a voxel, and that has a number already.
    const bool numbered = small && triangle.low == triangle.high && voxel_number[voxel_place(triangle.low)] != 0u;
    if (gl_LocalInvocationID.x == 0u) wide_count = 0u;
    mark_pieces(triangle, small && !numbered);
    if (found && !small) {
        const TileSearch search = search_of(triangle);
        if (search.count.x * search.count.y <= int(piece_invocations)) list_tiles(triangle, search, 0, 1);
        else wide[atomicAdd(wide_count, 1u)] = gl_LocalInvocationID.x;
    }
    barrier();
    // Those of many tiles have them sought by all.
    for (uint i = 0u; i < wide_count; ++i) {
        if (find_triangle(linear_group() * piece_invocations + wide[i], triangle))
            list_tiles(triangle, search_of(triangle), int(gl_LocalInvocationID.x), int(piece_invocations));
    }
}
