#version 460
#extension GL_GOOGLE_include_directive : require
// How many sides the volumes of each instance have by the choice of triangles.
#include "passes/shadow_volumes/edges.glsl"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, std430) buffer Tallies { CasterTally tallies[]; };
layout(push_constant) uniform Push { SilhouetteConstants push; };

void main() {
    const uint number = linear_invocation();
    if (number >= push.count) return;
    const uint caster = caster_of_edge(number, push.range_count);
    const CasterRange range = caster_ranges[caster];
    const CasterEdge edge = edge_of(range, number);
    const uint lit = uint(abs(sides_at(range, edge, behind_lit)));
    const uint joined = uint(abs(sides_at(range, edge, behind_joined)));
    const uint all = uint(abs(sides_at(range, edge, behind_all)));
    if (lit != 0u) atomicAdd(tallies[caster].lit, lit);
    if (joined != 0u) atomicAdd(tallies[caster].joined, joined);
    if (all != 0u) atomicAdd(tallies[caster].all, all);
}
