// What the traced pixels about each one tell of the lights that reach it.
#ifndef HELIODON_PIXEL_SHADOWS_GLSL
#define HELIODON_PIXEL_SHADOWS_GLSL
#include "passes/cone_trace/traced_pixels.glsl"
#include "passes/shadow_cones/shadow_cones.glsl"

layout(set = 0, binding = 19) uniform usampler2D traced_shadows;  // of shadow_pixels.comp

// On one plane shares are interpolated: below this error the traced pixels count alike.
const float least_error = 1.0f / 256.0f;

/// The mean of the four about a pixel, each by its bilinear share over the error of taking it for this one (Ward, Rubinstein &
/// Clear 1988, "A Ray Tracing Solution for Diffuse Interreflection", eq. 3 and 4): a pixel unlike all four takes the likest.
/// For the distance to other surfaces stands a voxel's edge, below which the volume knows no detail.
vec4 pixel_shares(ivec2 pixel, vec3 position, vec3 geometric, FrameData frame) {
    const ivec2 size = ivec2(frame.width, frame.height);
    const AboutPixel about = about_pixel(pixel, frame.sample_index, size);
    vec4 sum = vec4(0.0f);
    float total = 0.0f;
    for (int i = 0; i < 4; ++i) {
        if (about.shares[i] == 0.0f) continue;
        const uvec4 traced = texelFetch(traced_shadows, about.cells[i], 0);
        if (traced.x == 0u) continue;
        const vec2 at = vec2(traced_pixel(about.cells[i], frame.sample_index, size)) + 0.5f + frame.jitter;
        const vec3 ray = frame.ray_corner + frame.ray_dx * at.x + frame.ray_dy * at.y;
        const vec3 offset = frame.position + uintBitsToFloat(traced.x) * ray - position;
        const float cosine = dot(geometric, octahedral_decode(unpackSnorm2x16(traced.y)));
        const float error = abs(dot(geometric, offset)) / volume.voxel_m + sqrt(max(0.0f, 1.0f - cosine));
        const float weight = about.shares[i] / max(error, least_error);
        sum += weight * unpack_shares(traced.zw);
        total += weight;
    }
    return total > 0.0f ? sum / total : vec4(1.0f);
}

#endif
