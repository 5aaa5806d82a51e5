#version 460
// The bidirectional kernel in GLSL, as kernel.comp has the path kernel.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;

#include "kernel_tables.glsl"
#include "shading/bidirectional_vertex.h"
#include "shading/light_emission.h"

const uint most_light_vertices = 16u;  // a path, in this test
layout(scalar, binding = 14) buffer States { BidirectionalState states[]; };
layout(scalar, binding = 16) buffer LightVertices { SubpathVertex light_vertices[]; };
/// The scene's sphere, then the cumulative probabilities of setting out from each emitter.
layout(scalar, binding = 17) readonly buffer Emission { float emission[]; };

/// What the test compares, beside the rays.
struct Outcome { vec3 radiance; uint light_vertices; vec3 splat_light; uint splat_pixel; };
layout(scalar, binding = 18) writeonly buffer Outcomes { Outcome outcomes[]; };

vec4 scene_sphere() { return vec4(emission[0], emission[1], emission[2], emission[3]); }
uint emission_count() { return emission.length() - 4u; }
float fetch_emission_cumulative(uint i) { return emission[4u + i]; }
SubpathVertex fetch_light_vertex(uint slot, uint i) { return light_vertices[most_light_vertices * slot + i]; }
void store_light_vertex(uint slot, uint i, SubpathVertex vertex) {
    if (i < most_light_vertices) light_vertices[most_light_vertices * slot + i] = vertex;
}

#include "shading/path_kernel.h"
uvec2 fetch_only_strategy() { return uvec2(bidirectional_any); }
#include "shading/bidirectional_kernel.h"

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= path_count) return;
    BidirectionalState state;
    if (begin != 0u) {
        state = bidirectional_begin(i % frames[0].width, i / frames[0].width, 0u, i);
    } else {
        state = states[i];
        if (state.walk.stage != kernel_stage_done) bidirectional_take_hit(state, hits[i]);
    }
    states[i] = state;
    rays[i] = path_next_ray(state.walk);
    outcomes[i] = Outcome(state.walk.radiance, state.light_vertices, state.splat_light, state.splat_pixel);
}
