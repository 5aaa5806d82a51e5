// Indirect light that leaves a blended surface towards the viewer: its lobes as cones, one after another.
#ifndef HELIODON_BLENDED_LIGHT_GLSL
#define HELIODON_BLENDED_LIGHT_GLSL
#include "passes/cone_trace/refracted.glsl"

/// cd/m².
vec3 indirect_reflected(SurfacePoint point, vec2 shift, float diagonal_m) {
    const vec3 wo = to_local(point.frame, point.wo);
    if (point.dark || wo.z <= 0.0f) return vec3(0.0f);
    const BsdfLobes lobes = bsdf_prepare(point.material.surface, wo);
    const ConeLobes albedo = cone_lobes(point.material.surface, lobes, volume.effects);
    const vec3 origin = cone_origin(point.position, point.geometric);
    vec3 sum = vec3(0.0f);
    if (albedo.diffuse != vec3(0.0f)) sum += albedo.diffuse * diffuse_light(origin, point.frame.normal, volume.cone_sets, shift).radiance;
    for (uint i = 0u; i < 2u; ++i) {
        const vec3 reflected = i == 0u ? albedo.specular : albedo.coat;
        if (reflected == vec3(0.0f)) continue;
        Cone cone = specular_cone(wo, i == 0u ? lobes.alpha : lobes.coat_alpha);
        cone.direction = to_world(point.frame, cone.direction);
        sum += reflected * cone_light(origin, cone).radiance;
    }
    if (albedo.refraction != vec3(0.0f)) sum += albedo.refraction * light_refracted(point, wo, lobes, diagonal_m);
    return sum;
}

#endif
