#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/shadow_volumes/volume_position.glsl"

void main() { gl_Position = volume_position(uint(gl_InstanceIndex), uint(gl_VertexIndex)); }
