// Indirect light that leaves a surface point towards the viewer: its lobes as cones through the volume.
#ifndef HELIODON_INDIRECT_GLSL
#define HELIODON_INDIRECT_GLSL
#include "passes/common/surface.glsl"
#include "passes/cone_trace/cone_light.glsl"

struct IndirectLight {
    vec3 radiance;   // cd/m²
    float openness;  // of the hemisphere, by cosine; 1 where no diffuse cones were traced
};

/// Albedos of the lobes that cones stand for; an effect that is switched off has none.
struct ConeLobes {
    vec3 diffuse;
    vec3 specular;
    vec3 coat;
    vec3 refraction;
};

ConeLobes cone_lobes(Surface surface, BsdfLobes lobes) {
    ConeLobes result = ConeLobes(vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f));
    if ((volume.effects & gi_effect_diffuse) != 0u) result.diffuse = bsdf_diffuse_albedo_prepared(surface, lobes);
    if ((volume.effects & gi_effect_specular) != 0u) {
        result.specular = bsdf_specular_albedo_prepared(surface, lobes);
        if (lobes.coat_albedo > 0.0f) result.coat = vec3(bsdf_coat_albedo_prepared(lobes));
    }
    if ((volume.effects & gi_effect_refraction) != 0u && lobes.glass > 0.0f)
        result.refraction = bsdf_transmission_albedo_prepared(surface, lobes);
    return result;
}

/// Cone `index` of a point: diffuse cones first, then one for each other lobe. `share`: what it adds of its radiance.
Cone lobe_cone(uint index, uint diffuse_cones, ConeLobes albedo, BsdfLobes lobes, vec3 wo, vec2 shift, out vec3 share) {
    Cone cone;
    share = vec3(0.0f);
    if (index < diffuse_cones) {
        cone = diffuse_cone(index % cones_per_set, index / cones_per_set, volume.cone_sets, shift);
        share = albedo.diffuse * cone.weight;
    } else if (index < diffuse_cones + 2u) {
        const bool coat = index != diffuse_cones;
        const vec3 energy = coat ? albedo.coat : albedo.specular;
        if (energy == vec3(0.0f)) return cone;
        cone = specular_cone(wo, coat ? lobes.coat_alpha : lobes.alpha);
        share = energy;
    } else if (albedo.refraction != vec3(0.0f)) {
        // The radiance that glass lets through: 1/η² of the refracted beam's, within; leaving it takes that back, and
        // the cone stands for the path through both (docs/gi-theory.md).
        if (refraction_cone(wo, lobes.alpha, lobes.eta, cone)) share = albedo.refraction * cone.weight;
    }
    return cone;
}

/// `known`: what diffuse cones bring, where that is known already: irradiance / π, and w ≥ 0 the openness.
IndirectLight indirect_light(SurfacePoint point, vec2 shift, vec4 known) {
    IndirectLight result = IndirectLight(vec3(0.0f), 1.0f);
    const vec3 wo = to_local(point.frame, point.wo);
    if (point.dark || wo.z <= 0.0f) return result;
    const BsdfLobes lobes = bsdf_prepare(point.material.surface, wo);
    const ConeLobes albedo = cone_lobes(point.material.surface, lobes);
    const bool traced = known.w < 0.0f && albedo.diffuse != vec3(0.0f);
    const uint diffuse_cones = traced ? volume.cone_sets * cones_per_set : 0u;
    if (known.w >= 0.0f) result = IndirectLight(albedo.diffuse * known.rgb, known.w);
    float open_sum = 0.0f;
    for (uint i = 0u; i < diffuse_cones + 3u; ++i) {
        vec3 share;
        Cone cone = lobe_cone(i, diffuse_cones, albedo, lobes, wo, shift, share);
        if (share == vec3(0.0f)) continue;
        const vec3 side = cone.direction.z < 0.0f ? -point.geometric : point.geometric;
        cone.direction = to_world(point.frame, cone.direction);
        const ConeLight light = cone_light(cone_origin(point.position, side), cone);
        result.radiance += share * light.radiance;
        if (i < diffuse_cones) open_sum += cone.weight * light.openness;
    }
    if (diffuse_cones > 0u) result.openness = open_sum;
    return result;
}

#endif
