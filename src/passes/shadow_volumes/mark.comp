#version 460
#extension GL_GOOGLE_include_directive : require
// What a texel of the map shows is lit.
#include "passes/shadow_volumes/shadow_volumes_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8) uniform usampler2D visibility;  // instance + 1, triangle
layout(set = 0, binding = 9, std430) readonly buffer FirstTriangles { uint first_triangle[]; };  // by instance
layout(set = 0, binding = 13, std430) buffer States { uint states[]; };
layout(set = 0, binding = 14, std430) buffer Header { LitMapHeader header; };
layout(push_constant) uniform Push { LitMapConstants push; };

void main() {
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (texel.x >= push.size || texel.y >= push.size) return;
    const uvec2 visible = texelFetch(visibility, ivec2(texel), 0).xy;
    if (visible.x == 0u) return;
    const uint triangle = first_triangle[visible.x - 1u] + visible.y;
    if ((states[triangle] & caster_lit) != 0u) return;
    const uint before = atomicOr(states[triangle], caster_lit);
    if ((before & (caster_lit | caster_significant)) == caster_significant) atomicAdd(header.found, 1u);
}
