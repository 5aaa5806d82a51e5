#version 460
#extension GL_GOOGLE_include_directive : require
// Edges that bound the triangles with volumes, whatever way the mesh is joined: those along which the triangles, turned
// to face the sun, do not go as often one way as the other. Each such time gives one side of a volume.
#include "passes/shadow_volumes/edges.glsl"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 14, std430) buffer Draws { VolumeDraw draws[]; };
layout(set = 0, binding = 15, std430) writeonly buffer Sides { uint sides[]; };  // instance, and the edge's vertices
layout(set = 0, binding = 16, std430) readonly buffer Tallies { CasterTally tallies[]; };
layout(push_constant) uniform Push { SilhouetteConstants push; };

void main() {
    const uint number = linear_invocation();
    if (number >= push.count) return;
    const uint caster = caster_of_edge(number, push.range_count);
    const CasterRange range = caster_ranges[caster];
    const CasterEdge edge = edge_of(range, number);
    const int sum = sides_at(range, edge, push.choice == behind_fewest ? fewest_sides(tallies[caster]) : push.choice);
    if (sum == 0) return;
    // The side goes along the edge the other way than the cap does.
    const uvec2 ends = sum > 0 ? uvec2(edge.b, edge.a) : uvec2(edge.a, edge.b);
    const uint count = uint(abs(sum));
    atomicAdd(draws[volume_edges].vertex_count, 1u);
    const uint first = atomicAdd(draws[volume_draw_sides].vertex_count, 3u * count) / 3u;
    for (uint i = first; i < min(first + count, push.capacity); ++i) {
        sides[3u * i] = range.instance;
        sides[3u * i + 1u] = ends.x;
        sides[3u * i + 2u] = ends.y;
    }
}
