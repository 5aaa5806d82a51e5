#version 460
#extension GL_GOOGLE_include_directive : require
// What is seen through transmissive surfaces.
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/listed_pixels.glsl"
#include "passes/cone_trace/refracted.glsl"

layout(local_size_x = 32) in;
layout(set = 0, binding = 16, rgba16f) uniform writeonly image2D transmitted;  // radiance in the volume's unit, before its albedo
layout(set = 0, binding = 25) uniform usampler2D visibility;

void main() {
    const uint index = linear_group() * 32u + gl_LocalInvocationID.x;
    if (index >= listed.groups[transmissive].w) return;
    const ivec2 pixel = listed_pixel(listed.pixels[transmissive * frame.width * frame.height + index]);
    const uvec2 visible = texelFetch(visibility, pixel, 0).xy;
    const SurfacePoint point = resolve_surface(visible.x - 1u, visible.y, frame, view_ray(pixel));
    const vec3 wo = to_local(point.frame, point.wo);
    const BsdfLobes lobes = bsdf_prepare(point.material.surface, wo);
    const vec3 radiance = light_refracted(point, wo, lobes, solid_diagonal(visible.x - 1u));
    imageStore(transmitted, pixel, vec4(in_volume_unit(radiance), 0.0f));
}
