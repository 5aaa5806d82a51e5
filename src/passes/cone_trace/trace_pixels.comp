#version 460
#extension GL_GOOGLE_include_directive : require
// Traces the diffuse cones and the specular one of one pixel in `spacing`²: 32 pixels by a workgroup, a row of 32 invocations
// for each cone of a pixel, so that a subgroup's cones go about the same way through about the same voxels.
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/traced_pixels.glsl"

const ivec2 tile = ivec2(8, 4);  // of traced pixels
layout(local_size_x = 32, local_size_y = 10) in;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D diffuse;   // irradiance / π in the volume's unit, openness
layout(set = 0, binding = 14, rgba16f) uniform writeonly image2D specular;  // radiance likewise

shared vec4 traced[cones_per_set * 32u];  // weighted radiance and openness

void main() {
    if (frame.batch != 0u) return;
    const uint row = gl_LocalInvocationID.y;
    const uint lane = gl_LocalInvocationID.x;
    const ivec2 cell = ivec2(gl_WorkGroupID.xy) * tile + ivec2(lane % uint(tile.x), lane / uint(tile.x));
    const bool within = all(lessThan(cell, imageSize(diffuse)));
    const ivec2 pixel = traced_pixel(cell, frame.sample_index, ivec2(frame.width, frame.height));
    const ConeSurface surface = surface_at(pixel);
    const bool diffuse_row = row < cones_per_set;
    const bool wanted = within && surface.depth_m > 0.0f && (diffuse_row ? surface.albedo.diffuse : surface.albedo.specular) != vec3(0.0f);
    const Frame about = frame_from_normal(surface.normal);
    Cone lobe = Cone(vec3(0.0f, 0.0f, 1.0f), 0.0f, 0.0f, 0.0f);
    if (!diffuse_row && wanted) lobe = specular_cone(viewer(pixel, surface.normal), surface.alpha);
    vec4 sum = vec4(0.0f);
    const uint cones = wanted ? (diffuse_row ? volume.cone_sets : 1u) : 0u;
    for (uint i = 0u; i < cones; ++i) {
        Cone cone = lobe;
        if (diffuse_row) cone = diffuse_cone(row, i, volume.cone_sets, frame.cone_shift);
        cone.direction = to_world(about, cone.direction);
        const ConeLight light = cone_light(cone_origin(position_at(pixel, surface.depth_m), surface.geometric), cone);
        sum += cone.weight * vec4(light.radiance, light.openness);
    }
    if (diffuse_row) traced[row * 32u + lane] = sum;
    barrier();
    if (!within) return;
    if (row == 0u) {
        for (uint other = 1u; other < cones_per_set; ++other) sum += traced[other * 32u + lane];
        imageStore(diffuse, cell, vec4(in_volume_unit(sum.rgb), sum.a));
    } else if (!diffuse_row) {
        imageStore(specular, cell, vec4(in_volume_unit(sum.rgb), 0.0f));
    }
}
