#version 460
#extension GL_GOOGLE_include_directive : require
// The running sum of all samples and light batches; whoever reads it divides by the number of samples.
#include "passes/accumulate/accumulate_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D contribution;
layout(set = 0, binding = 1, rgba32f) uniform image2D accumulated;
layout(push_constant) uniform Push { AccumulateConstants push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) return;
    vec4 sum = imageLoad(contribution, pixel);
    if (push.replace == 0u) sum += imageLoad(accumulated, pixel);
    imageStore(accumulated, pixel, sum);
}
