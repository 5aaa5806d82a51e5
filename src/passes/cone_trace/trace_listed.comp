#version 460
#extension GL_GOOGLE_include_directive : require
// Adds to the picture the light of the cones of pixels unlike those about them: its diffuse cones, if those are wanted, the
// specular one and that of its coat, one after another. Most want a single one.
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/listed_pixels.glsl"

layout(local_size_x = 32) in;
layout(constant_id = 0) const bool draws_aov = false;
layout(set = 0, binding = 13, rgba32f) uniform image2D picture;

void main() {
    const uint index = linear_group() * 32u + gl_LocalInvocationID.x;
    if (index >= listed.groups[unlike].w) return;
    const uint packed_pixel = listed.pixels[unlike * frame.width * frame.height + index];
    const ivec2 pixel = listed_pixel(packed_pixel);
    const ConeSurface surface = surface_at(pixel);
    const Frame about = frame_from_normal(surface.normal);
    const vec3 origin = cone_origin(position_at(pixel, surface.depth_m), surface.geometric);
    const uint diffuse_cones = listed_has_diffuse(packed_pixel) ? 0u : cones_per_set * volume.cone_sets;
    vec4 sum = vec4(0.0f);  // radiance towards the viewer, openness
    for (uint i = 0u; i < diffuse_cones + 2u; ++i) {
        const bool diffuse = i < diffuse_cones;
        const bool coat = i == diffuse_cones + 1u;
        Cone cone;
        vec3 albedo = surface.albedo.diffuse;
        if (diffuse) {
            cone = diffuse_cone(i % cones_per_set, i / cones_per_set, volume.cone_sets, frame.cone_shift);
        } else {
            albedo = coat ? surface.albedo.coat : listed_has_specular(packed_pixel) ? vec3(0.0f) : surface.albedo.specular;
            if (albedo == vec3(0.0f)) continue;
            cone = specular_cone(viewer(pixel, surface.normal), coat ? surface.coat_alpha : surface.alpha);
        }
        cone.direction = to_world(about, cone.direction);
        const ConeLight light = cone_light(origin, cone);
        sum += cone.weight * vec4(albedo * light.radiance, diffuse ? light.openness : 0.0f);
    }
    vec4 value = imageLoad(picture, pixel);
    value.rgb += draws_aov && frame.aov == frame_aov_occlusion ? vec3(sum.a) : sum.rgb;
    imageStore(picture, pixel, value);
}
