#version 460
#extension GL_GOOGLE_include_directive : require
// The histogram of a picture's luminance: of each workgroup's pixels in its own memory, then of all.
#include "passes/meter/meter_shared.h"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D accumulated;
layout(set = 0, binding = 1, std430) buffer Histogram { uint histogram[]; };  // counts of both rings, then sums
layout(push_constant) uniform Push { MeterConstants push; };

const uint words = 4u * metering_bins;
shared uint counted[words];

void main() {
    const uint lanes = gl_WorkGroupSize.x * gl_WorkGroupSize.y;
    for (uint word = gl_LocalInvocationIndex; word < words; word += lanes) counted[word] = 0u;
    barrier();
    const uvec2 pixel = gl_GlobalInvocationID.xy * metering_stride(push.width, push.height);
    if (pixel.x < push.width && pixel.y < push.height) {
        const float light = luminance(imageLoad(accumulated, ivec2(pixel)).rgb) * push.sample_scale;
        const float place = metering_place(isnan(light) || isinf(light) ? 0.0f : light);
        const uint ring = metering_inside(push.pattern, pixel.x, pixel.y, push.width, push.height) ? 0u : 1u;
        const uint bin = ring * metering_bins + uint(place);
        atomicAdd(counted[bin], 1u);
        atomicAdd(counted[2u * metering_bins + bin], metering_steps(place));
    }
    barrier();
    for (uint word = gl_LocalInvocationIndex; word < words; word += lanes)
        if (counted[word] != 0u) atomicAdd(histogram[word], counted[word]);
}
