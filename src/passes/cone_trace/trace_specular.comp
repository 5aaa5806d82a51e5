#version 460
#extension GL_GOOGLE_include_directive : require
// Traces the specular cones of pixels unlike those about them, and those of clear coats.
#include "passes/cone_trace/cone_light.glsl"
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/listed_pixels.glsl"

layout(local_size_x = listed_a_group) in;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D specular;  // radiance towards the viewer in the volume's unit

vec3 reflected(ivec2 pixel, ConePlace surface, float alpha, vec3 albedo) {
    vec3 weight;
    Cone cone = reflection_cone(viewer(pixel, surface.normal), alpha, albedo, cone_shift_at(pixel), frame.cone_share, weight);
    if (weight == vec3(0.0f)) return vec3(0.0f);
    cone.direction = to_world(frame_from_normal(surface.normal), cone.direction);
    return cone_light(cone_origin(position_at(pixel, surface.depth_m), surface.geometric), cone).radiance * weight * albedo;
}

void main() {
    uint packed_pixel;
    if (!listed_entry(unlike_specular, linear_group() * listed_a_group + gl_LocalInvocationID.x, frame.width * frame.height, packed_pixel))
        return;
    const ivec2 pixel = listed_pixel(packed_pixel);
    const ConePlace surface = place_at(pixel);
    const ConeLobes albedo = lobes_at(pixel);
    vec3 radiance = vec3(0.0f);
    for (uint coat = listed_has_specular(packed_pixel) ? 1u : 0u; coat < (surface.coated ? 2u : 1u); ++coat)
        radiance += reflected(pixel, surface, coat == 0u ? surface.alpha : surface.coat_alpha, coat == 0u ? albedo.specular : albedo.coat);
    imageStore(specular, pixel, vec4(in_volume_unit(radiance), 0.0f));
}
