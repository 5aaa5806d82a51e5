#version 460
#extension GL_GOOGLE_include_directive : require
// What is seen through transmissive surfaces: an invocation a cone.
#include "passes/cone_trace/cone_light.glsl"
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/listed_pixels.glsl"
#include "passes/cone_trace/refracted.glsl"

layout(local_size_x = listed_a_group, local_size_y = refracted_cones) in;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D transmitted;  // radiance in the volume's unit, before its albedo
layout(set = 0, binding = 25) uniform usampler2D visibility;

shared Refracted found[listed_a_group];
shared vec3 traced[refracted_cones][listed_a_group];

Refracted refracted_at(ivec2 pixel) {
    const uvec2 visible = texelFetch(visibility, pixel, 0).xy;
    const SurfacePoint point = resolve_surface(visible.x - 1u, visible.y, frame, view_ray(pixel));
    const vec3 wo = to_local(point.frame, point.wo);
    return refracted(point, wo, bsdf_prepare(point.material.surface, wo), solid_diagonal(visible.x - 1u));
}

vec3 trace(Refracted through, uint index) {
    vec3 origin;
    const Cone cone = refracted_cone(through, index, origin);
    return cone.weight > 0.0f ? cone.weight * through.tint * cone_light(origin, cone).radiance : vec3(0.0f);
}

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint row = gl_LocalInvocationID.y;
    uint packed_pixel;
    const bool there = listed_entry(transmissive, linear_group() * listed_a_group + lane, frame.width * frame.height, packed_pixel);
    const ivec2 pixel = listed_pixel(packed_pixel);
    if (there && row == 0u) found[lane] = refracted_at(pixel);
    barrier();
    if (there) traced[row][lane] = trace(found[lane], row);
    barrier();
    if (!there || row > 0u) return;
    vec3 radiance = traced[0][lane];
    for (uint i = 1u; i < refracted_cones; ++i) radiance += traced[i][lane];
    imageStore(transmitted, pixel, vec4(in_volume_unit(radiance), 0.0f));
}
