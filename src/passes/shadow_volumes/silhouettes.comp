#version 460
#extension GL_GOOGLE_include_directive : require
// Edges that bound the triangles with volumes, whatever way the mesh is joined: those along which the triangles, turned
// to face the sun, do not go as often one way as the other. Each such time gives one side of a volume.
#include "passes/shadow_volumes/casters.glsl"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 9, std430) readonly buffer Edges { CasterEdge edges[]; };
layout(set = 0, binding = 10, std430) readonly buffer EdgeUses { uint edge_uses[]; };
layout(set = 0, binding = 13, std430) readonly buffer States { uint states[]; };
layout(set = 0, binding = 14, std430) buffer Draws { VolumeDraw draws[]; };
layout(set = 0, binding = 15, std430) writeonly buffer Sides { uint sides[]; };  // instance, and the edge's vertices
layout(push_constant) uniform Push { SilhouetteConstants push; };

void main() {
    const uint number = linear_invocation();
    if (number >= push.count) return;
    const CasterRange range = caster_of_edge(number, push.range_count);
    const CasterEdge edge = edges[range.edge_table + number - range.first_edge];
    int sum = 0;
    for (uint i = 0u; i < edge.use_count; ++i) {
        const uint use = edge_uses[edge.first_use + i];
        const uint state = states[range.first_triangle + (use >> 1)];
        if (!casts_volume(state, push.all_triangles)) continue;
        const bool forth = (state & caster_toward) != 0u;
        sum += forth == ((use & 1u) == 0u) ? 1 : -1;
    }
    if (sum == 0) return;
    // The side goes along the edge the other way than the cap does.
    const uvec2 ends = sum > 0 ? uvec2(edge.b, edge.a) : uvec2(edge.a, edge.b);
    const uint count = uint(abs(sum));
    const uint first = atomicAdd(draws[volume_draw_sides].vertex_count, 3u * count) / 3u;
    for (uint i = first; i < min(first + count, push.capacity); ++i) {
        sides[3u * i] = range.instance;
        sides[3u * i + 1u] = ends.x;
        sides[3u * i + 2u] = ends.y;
    }
}
