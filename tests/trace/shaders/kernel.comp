#version 460
// The light-transport kernel in GLSL, over buffers: one invocation follows path `i` through the answers in
// `hits`, as far as they go, and leaves its state. The test answers the rays on the CPU and compares.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;

#include "kernel_tables.glsl"

layout(scalar, binding = 14) buffer States { PathState states[]; };

#include "shading/path_kernel.h"

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= path_count) return;
    PathState state;
    if (begin != 0u) {
        state = path_begin(i % frames[0].width, i / frames[0].width, 0u);
    } else {
        state = states[i];
        if (state.stage != kernel_stage_done) path_take_hit(state, hits[i]);
    }
    states[i] = state;
    rays[i] = path_next_ray(state);
}
