#version 460
// The geometry shader fetches the triangle.
void main() { gl_Position = vec4(0.0f); }
