// Indirect light that leaves a blended surface towards the viewer: its lobes as cones, one after another.
#ifndef HELIODON_BLENDED_LIGHT_GLSL
#define HELIODON_BLENDED_LIGHT_GLSL
#include "passes/cone_trace/refracted.glsl"

/// cd/m². `shift` and `cone_share` of diffuse_cone(); `diagonal_m`: solid_diagonal().
vec3 indirect_reflected(SurfacePoint point, vec2 shift, float cone_share, float diagonal_m) {
    const vec3 wo = to_local(point.frame, point.wo);
    if (point.dark || wo.z <= 0.0f) return vec3(0.0f);
    const BsdfLobes lobes = bsdf_prepare(point.material.surface, wo);
    const ConeLobes albedo = cone_lobes(point.material.surface, lobes, volume.effects);
    Refracted through;
    if (albedo.refraction != vec3(0.0f)) through = refracted(point, wo, lobes, diagonal_m);
    const vec3 outside = cone_origin(point.position, point.geometric);
    const uint diffuse_cones = albedo.diffuse != vec3(0.0f) ? volume.cone_sets * cones_per_set : 0u;
    const uint reflections = diffuse_cones + 2u;
    const uint cones = reflections + (albedo.refraction != vec3(0.0f) ? refracted_cones : 0u);
    vec3 sum = vec3(0.0f);
    // All of them by one loop: the tracing of a cone is much code.
    for (uint i = 0u; i < cones; ++i) {
        Cone cone;
        vec3 origin = outside;
        vec3 share;
        if (i < diffuse_cones) {
            share = albedo.diffuse;
            cone = diffuse_cone(i % cones_per_set, i / cones_per_set, volume.cone_sets, shift, cone_share);
        } else if (i < reflections) {
            const bool coat = i != diffuse_cones;
            share = coat ? albedo.coat : albedo.specular;
            vec3 weight;
            cone = reflection_cone(wo, coat ? lobes.coat_alpha : lobes.alpha, share, shift, cone_share, weight);
            share *= weight;
            if (share == vec3(0.0f)) continue;
        } else {
            share = albedo.refraction * through.tint;
            cone = refracted_cone(through, i - reflections, origin);
        }
        if (i < reflections) cone.direction = to_world(point.frame, cone.direction);
        if (cone.weight > 0.0f) sum += share * cone.weight * cone_light(origin, cone).radiance;
    }
    return sum;
}

#endif
