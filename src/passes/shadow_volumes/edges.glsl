// The edges of the instances that cast shadows.
#ifndef HELIODON_CASTER_EDGES_GLSL
#define HELIODON_CASTER_EDGES_GLSL
#include "passes/shadow_volumes/casters.glsl"

layout(set = 0, binding = 9, std430) readonly buffer Edges { CasterEdge edges[]; };
layout(set = 0, binding = 10, std430) readonly buffer EdgeUses { uint edge_uses[]; };
layout(set = 0, binding = 13, std430) readonly buffer States { uint states[]; };

CasterEdge edge_of(CasterRange range, uint number) { return edges[range.edge_table + number - range.first_edge]; }
uint triangle_of_use(CasterRange range, uint use) { return range.first_triangle + (edge_uses[use] >> 1); }

/// Which way the triangle goes along the edge, turned to face the sun: 1 from a to b, or -1.
int way_of_use(uint use, uint state) {
    return ((state & caster_toward) != 0u) == ((edge_uses[use] & 1u) == 0u) ? 1 : -1;
}

/// How much more often triangles with volumes go along the edge from a to b than back. Each such time is a side.
int sides_at(CasterRange range, CasterEdge edge, uint choice) {
    int sum = 0;
    for (uint use = edge.first_use; use < edge.first_use + edge.use_count; ++use) {
        const uint state = states[triangle_of_use(range, use)];
        if (casts_volume(state, choice)) sum += way_of_use(use, state);
    }
    return sum;
}

#endif
