#version 460
#extension GL_GOOGLE_include_directive : require
// The exposure by the histogram, as far as it has adapted; leaves the histogram empty for the next frame.
#include "passes/meter/meter_shared.h"

layout(local_size_x = 256) in;
layout(set = 0, binding = 0, std430) buffer Histogram { uint histogram[]; };
layout(set = 0, binding = 1, std430) buffer State { ExposureState state; };
layout(push_constant) uniform Push { ExposeConstants push; };

shared uint counted[4u * metering_bins];

SHADING_FN uint metering_count(uint ring, uint bin) { return counted[ring * metering_bins + bin]; }
SHADING_FN uint metering_sum(uint ring, uint bin) { return counted[(2u + ring) * metering_bins + bin]; }
#include "shading/metering_fetch.h"

void main() {
    const bool metered = push.mode != exposure_by_camera || push.estimate_white != 0u;
    if (metered) {
        for (uint word = gl_LocalInvocationIndex; word < 4u * metering_bins; word += gl_WorkGroupSize.x) {
            counted[word] = histogram[word];
            histogram[word] = 0u;
        }
    }
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;

    Metering m;
    m.luminance_nits = 0.0f;
    if (metered) m = metering_read(push.pattern, push.arithmetic != 0u, push.low_percentile, push.high_percentile);
    float wanted = push.camera_ev100;
    if (push.mode == exposure_metered) wanted = ev100_from_metered_luminance(m.luminance_nits);
    if (push.mode == exposure_by_key) wanted = ev100_from_key(m);
    wanted -= push.compensation_ev;
    const bool adapts = push.adapts != 0u && state.started != 0u && push.mode != exposure_by_camera;
    state.ev100 = adapts ? adapted_ev100(state.ev100, wanted, push.seconds, push.to_light_s, push.to_dark_s) : wanted;
    state.wanted = wanted;
    state.white = push.estimate_white != 0u ? estimated_white(m) : push.white;
    state.started = 1u;
}
