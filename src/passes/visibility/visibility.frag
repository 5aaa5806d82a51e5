#version 460
layout(location = 0) flat in uint instance_index;
layout(location = 0) out uvec2 visible;  // instance + 1, triangle

void main() { visible = uvec2(instance_index + 1u, uint(gl_PrimitiveID)); }
