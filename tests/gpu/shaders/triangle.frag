#version 460

layout(location = 0) in vec3 color;
layout(location = 0) out vec4 target;
layout(push_constant) uniform Push { float scale; };

void main() { target = vec4(scale * color, 1.0); }
