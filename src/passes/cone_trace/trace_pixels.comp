#version 460
#extension GL_GOOGLE_include_directive : require
// Traces the diffuse cones and the specular one of one pixel in `spacing`²: 32 pixels by a workgroup in rows of 32
// invocations, each with the same cones of its pixels, so that a subgroup's cones go about the same way through about
// the same voxels. Few pixels need more rows to fill a device; many are faster with fewer, which wait less for each other.
#include "passes/cone_trace/cone_light.glsl"
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/traced_pixels.glsl"

const ivec2 tile = ivec2(8, 4);  // of traced pixels
layout(local_size_x = 32, local_size_y_id = 2) in;
layout(constant_id = 2) const uint rows = 5u;  // 2 or 5
const uint in_turn = (cones_per_set + 1u) / rows;
const uint most_rows = 5u;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D diffuse;   // irradiance / π in the volume's unit, openness
layout(set = 0, binding = 14, rgba16f) uniform writeonly image2D specular;  // radiance likewise

shared vec4 traced[most_rows * 32u];  // weighted radiance and openness

void main() {
    if (frame.batch != 0u) return;
    const uint row = gl_LocalInvocationID.y;
    const uint lane = gl_LocalInvocationID.x;
    const ivec2 cell = ivec2(gl_WorkGroupID.xy) * tile + ivec2(lane % uint(tile.x), lane / uint(tile.x));
    const bool within = all(lessThan(cell, imageSize(diffuse)));
    const ivec2 pixel = traced_pixel(cell, frame.sample_index, ivec2(frame.width, frame.height));
    const ConePlace surface = place_at(pixel);
    const vec2 shift = spacing == 1 ? cone_shift_at(pixel) : frame.cone_shift;  // neighbours take the mean of those
    const Frame about = frame_from_normal(surface.normal);
    const vec3 origin = cone_origin(position_at(pixel, surface.depth_m), surface.geometric);
    vec4 sum = vec4(0.0f);
    vec3 reflected = vec3(0.0f);
    for (uint i = 0u; i < in_turn * volume.cone_sets; ++i) {
        const uint index = row * in_turn + i % in_turn;
        const bool lobe = index == cones_per_set;
        if (!within || (lobe ? !surface.glossy || i >= in_turn : !surface.rough || index > cones_per_set)) continue;
        Cone cone;
        vec3 weight = vec3(1.0f);
        if (lobe) cone = reflection_cone(viewer(pixel, surface.normal), surface.alpha, lobes_at(pixel).specular, shift, frame.cone_share, weight);
        else cone = diffuse_cone(index, i / in_turn, volume.cone_sets, shift, frame.cone_share);
        cone.direction = to_world(about, cone.direction);
        const ConeLight light = cone_light(origin, cone);
        if (lobe) reflected = weight * light.radiance;
        else sum += cone.weight * vec4(light.radiance, light.openness);
    }
    traced[row * 32u + lane] = sum;
    if (within && row == rows - 1u) imageStore(specular, cell, vec4(in_volume_unit(reflected), 0.0f));
    barrier();
    if (!within || row > 0u) return;
    for (uint other = 1u; other < rows; ++other) sum += traced[other * 32u + lane];
    imageStore(diffuse, cell, vec4(in_volume_unit(sum.rgb), sum.a));
}
