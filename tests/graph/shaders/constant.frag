#version 460

layout(location = 0) out vec4 target;
layout(push_constant) uniform Push { vec4 color; };

void main() { target = color; }
