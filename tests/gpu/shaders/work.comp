#version 460

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint rounds = 1u;
layout(binding = 0) buffer Values { uint values[]; };

void main() {
    uint x = gl_GlobalInvocationID.x;
    for (uint i = 0u; i < rounds; ++i) x = x * 1664525u + 1013904223u;
    values[gl_GlobalInvocationID.x] = x;
}
