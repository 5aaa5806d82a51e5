#version 460
#extension GL_GOOGLE_include_directive : require
// Appends to the pixel's list (Yang et al. 2010, "Real-Time Concurrent Linked List Construction on the
// GPU"). Fragments beyond the capacity are counted, not stored: the renderer then makes room and repeats.
#include "passes/common/scene_tables.glsl"
#include "passes/blend/blend_shared.h"

layout(early_fragment_tests) in;
layout(set = 0, binding = 9, std140) uniform Frame_ { FrameData frame; };
layout(set = 0, binding = 10, std430) buffer Fragments { uint fragment_count; uint fragment_demand; uint padding1; uint padding2; BlendFragment fragments[]; };
layout(set = 0, binding = 11, std430) buffer Heads { uint heads[]; };
layout(location = 0) flat in uint instance_index;

void main() {
    const uint slot = atomicAdd(fragment_count, 1u);
    if (slot >= frame.fragment_capacity) return;
    const uint pixel = uint(gl_FragCoord.y) * frame.width + uint(gl_FragCoord.x);
    fragments[slot].instance = instance_index;
    fragments[slot].triangle = uint(gl_PrimitiveID);
    fragments[slot].depth = gl_FragCoord.z;
    fragments[slot].next = atomicExchange(heads[pixel], slot + 1u);
}
