#version 460
layout(binding = 1) buffer Count { uint count; };

void main() { atomicAdd(count, 1u); }
