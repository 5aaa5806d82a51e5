#version 460
#extension GL_GOOGLE_include_directive : require
// Of one pixel in `spacing`² finds what of the batch's lights reaches its surface.
#include "passes/common/surface.glsl"
#include "passes/cone_trace/traced_pixels.glsl"
#include "passes/shadow_cones/shadow_cones.glsl"

layout(local_size_x = 8, local_size_y = 4) in;
layout(set = 0, binding = 8, std140) uniform Frame_ { FrameData frame; };
layout(set = 0, binding = 12) uniform usampler2D visibility;
layout(set = 0, binding = 13, rgba32ui) uniform writeonly uimage2D traced_shadows;  // depth, geometric normal, shares
float shading_table(uint index) { return 0.0f; }  // no material is evaluated

void main() {
    const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, imageSize(traced_shadows)))) return;
    const ivec2 pixel = traced_pixel(cell, frame.sample_index, ivec2(frame.width, frame.height));
    const uvec2 visible = texelFetch(visibility, pixel, 0).xy;
    if (visible.x == 0u) {
        imageStore(traced_shadows, cell, uvec4(0u));  // no depth: nothing
        return;
    }
    const vec2 at = vec2(pixel) + 0.5f + frame.jitter;
    const vec3 direction = frame.ray_corner + frame.ray_dx * at.x + frame.ray_dy * at.y;
    const InstanceData instance = instance_table[visible.x - 1u];
    const TriangleHit hit = intersect(instance, geometry_table[instance.geometry], visible.y, frame.position, direction);
    const vec3 position = hit_position(hit);
    const vec3 outward = outward_normal(instance, hit);
    const vec3 geometric = dot(outward, direction) > 0.0f ? -outward : outward;
    vec4 shares = vec4(1.0f);
    for (uint i = 0u; i < min(frame.light_count, most_lights_traced); ++i) {
        const LightData light = shining_light(frame.light_first + i);
        if (light.cone_radius > 0.0f) shares[i] = cone_shadow(light, position, geometric);
    }
    const float depth_m = dot(position - frame.position, frame.forward);
    imageStore(traced_shadows, cell,
               uvec4(floatBitsToUint(depth_m), packSnorm2x16(octahedral_encode(geometric)), pack_shares(shares)));
}
