// What shading, or a pass ahead of it, leaves of a surface for its cones. The includer defines shading_table().
#ifndef HELIODON_LEFT_SURFACE_GLSL
#define HELIODON_LEFT_SURFACE_GLSL
#include "passes/common/surface.glsl"
#include "passes/cone_trace/cone_surface.glsl"
#include "passes/cone_trace/volume_data.glsl"

layout(set = 0, binding = 14, rgba32ui) uniform writeonly uimage2D surface_places;
layout(set = 0, binding = 17, rgba32ui) uniform writeonly uimage2D surface_albedos;
layout(set = 0, binding = 18, r32ui) uniform writeonly uimage2D surface_lobes;

void leave_nothing(ivec2 pixel) { imageStore(surface_places, pixel, uvec4(0u)); }  // no depth

void leave_surface(ivec2 pixel, SurfacePoint point, vec3 wo, BsdfLobes lobes, FrameData frame) {
    // Nothing is seen of the back of a one-sided surface.
    const uint lit = sky_follows ? gi_effect_diffuse | gi_effect_specular : volume.effects;
    const uint effects = point.dark || wo.z <= 0.0f ? 0u : lit;
    ConeLobes albedo = cone_lobes(point.material.surface, lobes, effects);
    if (sky_follows) albedo.diffuse *= point.material.occlusion;
    if (frame.aov == frame_aov_illuminance) albedo.diffuse *= pi;
    const float depth_m = dot(point.position - frame.position, frame.forward);
    const PackedSurface packed_surface = pack_surface(ConeSurface(depth_m, point.geometric, point.frame.normal, lobes.alpha, lobes.coat_alpha, albedo));
    imageStore(surface_places, pixel, packed_surface.place);
    imageStore(surface_albedos, pixel, packed_surface.albedos);
    imageStore(surface_lobes, pixel, uvec4(packed_surface.lobes));
}

#endif
