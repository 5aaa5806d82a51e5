#version 460
#extension GL_GOOGLE_include_directive : require
// Adds to the picture the light of the cones of pixels unlike those about them: 32 pixels by a workgroup, in three rows; each has a third of the
// diffuse cones, if those are wanted; the first has the specular one, too, and the second that of the coat.
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/listed_pixels.glsl"

const uint rows = 3u;
layout(local_size_x = 32, local_size_y = 3) in;
layout(constant_id = 0) const bool draws_aov = false;
layout(set = 0, binding = 13, rgba32f) uniform image2D picture;

shared vec4 traced[rows * 32u];  // radiance towards the viewer, openness

void main() {
    const uint row = gl_LocalInvocationID.y;
    const uint lane = gl_LocalInvocationID.x;
    const uint index = linear_group() * 32u + lane;
    const bool within = index < listed.groups[unlike].w;
    const uint packed_pixel = within ? listed.pixels[unlike * frame.width * frame.height + index] : 0u;
    const ivec2 pixel = listed_pixel(packed_pixel);
    vec4 sum = vec4(0.0f);
    if (within) {
        const ConeSurface surface = surface_at(pixel);
        const Frame about = frame_from_normal(surface.normal);
        const bool specular = row == 0u && !listed_has_specular(packed_pixel);
        const vec3 albedo = row == 1u ? surface.albedo.coat : specular ? surface.albedo.specular : vec3(0.0f);
        Cone lobe = Cone(vec3(0.0f, 0.0f, 1.0f), 0.0f, 0.0f, 0.0f);
        if (albedo != vec3(0.0f)) lobe = specular_cone(viewer(pixel, surface.normal), row == 1u ? surface.coat_alpha : surface.alpha);
        const vec3 origin = cone_origin(position_at(pixel, surface.depth_m), surface.geometric);
        const uint cells = cones_per_set / rows;
        const uint diffuse_cones = listed_has_diffuse(packed_pixel) ? 0u : cells * volume.cone_sets;
        const uint cones = diffuse_cones + uint(albedo != vec3(0.0f));
        for (uint i = 0u; i < cones; ++i) {
            const bool diffuse = i < diffuse_cones;
            Cone cone = lobe;
            if (diffuse) cone = diffuse_cone(row * cells + i % cells, i / cells, volume.cone_sets, frame.cone_shift);
            cone.direction = to_world(about, cone.direction);
            const ConeLight light = cone_light(origin, cone);
            sum += diffuse ? cone.weight * vec4(surface.albedo.diffuse * light.radiance, light.openness) : vec4(albedo * light.radiance, 0.0f);
        }
    }
    traced[row * 32u + lane] = sum;
    barrier();
    if (!within || row != 0u) return;
    for (uint other = 1u; other < rows; ++other) sum += traced[other * 32u + lane];
    vec4 value = imageLoad(picture, pixel);
    value.rgb += draws_aov && frame.aov == frame_aov_occlusion ? vec3(sum.a) : sum.rgb;
    imageStore(picture, pixel, value);
}
