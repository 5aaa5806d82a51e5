#version 460
#extension GL_GOOGLE_include_directive : require
// Traces the diffuse cones of pixels unlike those about them: an invocation traces one of each set, so that none waits for
// nine in turn.
#include "passes/cone_trace/cone_light.glsl"
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/listed_pixels.glsl"

layout(local_size_x = listed_a_group, local_size_y = cones_per_set) in;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D diffuse;  // irradiance / π in the volume's unit, openness

shared vec4 traced[cones_per_set][listed_a_group];  // weighted radiance and openness

vec4 trace_sets(ivec2 pixel, uint index) {
    const ConePlace surface = place_at(pixel);
    const Frame about = frame_from_normal(surface.normal);
    const vec3 origin = cone_origin(position_at(pixel, surface.depth_m), surface.geometric);
    vec4 sum = vec4(0.0f);
    for (uint set = 0u; set < volume.cone_sets; ++set) {
        Cone cone = diffuse_cone(index, set, volume.cone_sets, cone_shift_at(pixel), frame.cone_share);
        cone.direction = to_world(about, cone.direction);
        const ConeLight light = cone_light(origin, cone);
        sum += cone.weight * vec4(light.radiance, light.openness);
    }
    return sum;
}

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint row = gl_LocalInvocationID.y;
    uint packed_pixel;
    const bool there = listed_entry(unlike_diffuse, linear_group() * listed_a_group + lane, frame.width * frame.height, packed_pixel);
    const ivec2 pixel = listed_pixel(packed_pixel);
    if (there) traced[row][lane] = trace_sets(pixel, row);
    barrier();
    if (!there || row > 0u) return;
    vec4 sum = traced[0][lane];
    for (uint i = 1u; i < cones_per_set; ++i) sum += traced[i][lane];
    imageStore(diffuse, pixel, vec4(in_volume_unit(sum.rgb), sum.a));
}
