#version 460
// One triangle over the whole picture.
void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0f - 1.0f, 0.0f, 1.0f); }
