#version 460
layout(location = 0) out uint shadowed;

void main() { shadowed = 1u; }
