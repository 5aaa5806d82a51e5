#version 460
#extension GL_GOOGLE_include_directive : require
#include "app/editor/overlay/overlay_shared.h"

// Dear ImGui's vertex: position, texture coordinate, colour (four bytes), 20 bytes in all.
layout(set = 0, binding = 0, std430) readonly buffer Vertices { uint words[]; } vertices;
layout(push_constant) uniform Push { OverlayPush push; };

layout(location = 0) out vec2 texcoord;
layout(location = 1) out vec4 color;

void main() {
    uint first = uint(gl_VertexIndex) * 5u;
    vec2 position = vec2(uintBitsToFloat(vertices.words[first]), uintBitsToFloat(vertices.words[first + 1u]));
    texcoord = vec2(uintBitsToFloat(vertices.words[first + 2u]), uintBitsToFloat(vertices.words[first + 3u]));
    color = unpackUnorm4x8(vertices.words[first + 4u]);
    gl_Position = vec4(position * push.scale + push.shift, 0.0, 1.0);
}
