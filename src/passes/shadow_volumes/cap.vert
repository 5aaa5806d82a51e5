#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/shadow_volumes/volume_position.glsl"

layout(set = 0, binding = 8, std430) readonly buffer Caps { uvec2 caps[]; };  // instance, first index

void main() {
    const uint vertex = uint(gl_VertexIndex);
    const uvec2 cap = caps[push.first + vertex / 3u];
    gl_Position = volume_position(cap.x, index_table[cap.y + vertex % 3u]);
}
