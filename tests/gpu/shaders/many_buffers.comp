#version 460

layout(local_size_x = 1) in;
layout(binding = 0) buffer Value { uint value; } values[40];
layout(push_constant) uniform Push { uint summand; };

void main() { values[39].value += values[0].value + summand; }
