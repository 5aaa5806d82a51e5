#version 460
#extension GL_GOOGLE_include_directive : require
// A side of a volume goes from an edge to the point at infinity that the sun shines to, w = 0 (Everitt & Kilgard 2002,
// "Practical and Robust Stenciled Shadow Volumes"): a triangle, since the sun's rays are parallel. Volumes end in that
// point and need no other cap.
#include "passes/shadow_volumes/volume_position.glsl"

layout(set = 0, binding = 8, std430) readonly buffer Sides { uint sides[]; };  // instance, and the edge's vertices

void main() {
    const uint corner = uint(gl_VertexIndex) % 3u;
    const uint side = uint(gl_VertexIndex) - corner;
    if (corner < 2u) gl_Position = volume_position(sides[side], sides[side + 1u + corner]);
    else gl_Position = push.world_to_clip * vec4(push.sun, 0.0f);
}
