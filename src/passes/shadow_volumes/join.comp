#version 460
#extension GL_GOOGLE_include_directive : require
// Triangles whose volumes leave fewer silhouettes join the lit ones. A volume behind a triangle that faces the sun
// changes no shadow: what it covers is covered by whatever hides the triangle.
#include "passes/shadow_volumes/shadow_volumes_shared.h"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 13, std430) buffer States { uint states[]; };
layout(set = 0, binding = 15, std430) buffer Weights { int weights[]; };
layout(push_constant) uniform Push { SilhouetteConstants push; };

void main() {
    const uint triangle = linear_invocation();
    if (triangle >= push.count) return;
    if (weights[triangle] < 0) states[triangle] |= caster_joined;
    weights[triangle] = 0;
}
