#version 460

layout(local_size_x = 1) in;
layout(binding = 0) buffer Tally { uint tally; };

void main() { atomicAdd(tally, 1u); }
