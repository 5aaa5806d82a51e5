#version 460
#extension GL_GOOGLE_include_directive : require
// Adds to the picture what the traced pixels about each one tell of its indirect light, and what it is seen through.
#include "passes/cone_trace/cone_light.glsl"
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/traced_pixels.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool draws_aov = false;
layout(set = 0, binding = 13, rgba32f) uniform image2D picture;
layout(set = 0, binding = 14) uniform sampler2D traced_diffuse;  // of trace_pixels.comp
layout(set = 0, binding = 15) uniform sampler2D traced_specular;
layout(set = 0, binding = 16) uniform usampler2D weights;       // of weigh_pixels.comp
layout(set = 0, binding = 27) uniform sampler2D own_diffuse;    // of trace_diffuse.comp
layout(set = 0, binding = 28) uniform sampler2D own_specular;   // of trace_specular.comp
layout(set = 0, binding = 17) uniform sampler2D transmitted;    // of trace_refracted.comp

/// The volume as a pixel's own cone sees it.
vec4 volume_seen(vec3 direction) {
    const float size = length(cross(frame.ray_dx, frame.ray_dy));
    const ConeResult seen = trace_cone(to_lattice(frame.position), normalize(direction), sqrt(size * inverse_pi), unlimited);
    return vec4(frame.aov == frame_aov_opacity ? vec3(seen.cover) : seen.radiance, 1.0f);
}

vec4 weighed(sampler2D traced, AboutPixel about, vec4 weights_of) {
    vec4 sum = vec4(0.0f);
    for (int i = 0; i < 4; ++i)
        if (weights_of[i] > 0.0f) sum += weights_of[i] * texelFetch(traced, about.cells[i], 0);
    return sum / (weights_of.x + weights_of.y + weights_of.z + weights_of.w);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 size = ivec2(frame.width, frame.height);
    if (any(greaterThanEqual(pixel, size)) || frame.batch != 0u) return;
    if (draws_aov && (frame.aov == frame_aov_voxels || frame.aov == frame_aov_opacity)) {
        imageStore(picture, pixel, volume_seen(view_ray(pixel)));
        return;
    }
    const ConePlace surface = place_at(pixel);
    if (surface.depth_m == 0.0f) return;
    const ConeLobes albedo = lobes_at(pixel);
    const AboutPixel about = about_pixel(pixel, frame.sample_index, size);
    const uvec2 packed_weights = texelFetch(weights, pixel, 0).xy;
    vec3 light = vec3(0.0f);
    float openness = 1.0f;  // where no diffuse cones stand for anything
    if (surface.rough) {
        const vec4 diffuse = packed_weights.x != 0u ? weighed(traced_diffuse, about, unpackUnorm4x8(packed_weights.x))
                                                    : texelFetch(own_diffuse, pixel, 0);
        light += albedo.diffuse * diffuse.rgb;
        openness = diffuse.a;
    }
    if (packed_weights.y != 0u) light += albedo.specular * weighed(traced_specular, about, unpackUnorm4x8(packed_weights.y)).rgb;
    if (surface.coated || (surface.glossy && packed_weights.y == 0u)) light += texelFetch(own_specular, pixel, 0).rgb;
    if (surface.transmissive) light += albedo.refraction * texelFetch(transmitted, pixel, 0).rgb;
    vec4 value = imageLoad(picture, pixel);
    value.rgb += draws_aov && frame.aov == frame_aov_occlusion ? vec3(openness) : light * volume.radiance_unit;
    imageStore(picture, pixel, value);
}
