#version 460
#extension GL_GOOGLE_include_directive : require
// How many sides more there would be with a triangle's volume than without.
#include "passes/shadow_volumes/edges.glsl"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 15, std430) buffer Weights { int weights[]; };
layout(push_constant) uniform Push { SilhouetteConstants push; };

void main() {
    const uint number = linear_invocation();
    if (number >= push.count) return;
    const CasterRange range = caster_ranges[caster_of_edge(number, push.range_count)];
    const CasterEdge edge = edge_of(range, number);
    const int sum = sides_at(range, edge, behind_joined);
    for (uint use = edge.first_use; use < edge.first_use + edge.use_count; ++use) {
        const uint triangle = triangle_of_use(range, use);
        const uint state = states[triangle];
        if (casts_volume(state, behind_joined) || !casts_volume(state, behind_all)) continue;
        atomicAdd(weights[triangle], abs(sum + way_of_use(use, state)) - abs(sum));
    }
}
