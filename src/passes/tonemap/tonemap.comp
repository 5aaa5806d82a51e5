#version 460
#extension GL_GOOGLE_include_directive : require
// cd/m² to display-encoded RGBA8: exposure, Hable's curve, sRGB.
#include "passes/tonemap/tonemap_shared.h"
#include "shading/tone.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D accumulated;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D display;
layout(push_constant) uniform Push { TonemapConstants push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) return;
    const vec3 exposed = imageLoad(accumulated, pixel).rgb * push.scale;
    imageStore(display, pixel, vec4(srgb_encode_rgb(tone_map(tone_curve_hable, hable_white, exposed)), 1.0f));
}
