#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/shadow/shadow_slope.glsl"

layout(location = 0) out vec2 slope;

void main() { slope = depth_slope(); }
