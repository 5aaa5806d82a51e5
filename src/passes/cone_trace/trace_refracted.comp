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
    const Refracted through = refracted(point, wo, lobes, solid_diagonal(visible.x - 1u));
    vec3 radiance = vec3(0.0f);
    for (uint i = 0u; i < refracted_cones; ++i) {
        vec3 origin;
        const Cone cone = refracted_cone(through, i, origin);
        if (cone.weight > 0.0f) radiance += cone.weight * through.tint * cone_light(origin, cone).radiance;
    }
    imageStore(transmitted, pixel, vec4(in_volume_unit(radiance), 0.0f));
}
