#version 460
#extension GL_GOOGLE_include_directive : require
#include "multiply_add_shared.h"

layout(local_size_x = 64) in;
layout(binding = 0) readonly buffer Input { uint values[]; } source;
layout(binding = 1) writeonly buffer Output { uint values[]; } target;
layout(push_constant) uniform Push { MultiplyAdd push; };

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index < push.count) target.values[index] = push.factor * source.values[index] + push.summand;
}
