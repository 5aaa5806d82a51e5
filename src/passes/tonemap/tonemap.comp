#version 460
#extension GL_GOOGLE_include_directive : require
// cd/m² to display-encoded RGBA8: white balance, exposure, tone curve, sRGB.
#include "passes/meter/meter_shared.h"
#include "passes/tonemap/tonemap_shared.h"
#include "shading/tone.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D accumulated;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D display;
layout(set = 0, binding = 2, std430) readonly buffer State { ExposureState exposure; };
layout(push_constant) uniform Push { TonemapConstants push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) return;
    const vec3 light = imageLoad(accumulated, pixel).rgb * push.sample_scale;
    const vec3 balanced = vec3(dot(push.balance_red.xyz, light), dot(push.balance_green.xyz, light), dot(push.balance_blue.xyz, light));
    const vec3 shown = tone_map(push.curve, exposure.white, balanced * exposure_scale(exposure.ev100));
    imageStore(display, pixel, vec4(srgb_encode_rgb(shown), 1.0f));
}
