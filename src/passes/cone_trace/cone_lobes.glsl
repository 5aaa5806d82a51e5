// The lobes of a surface that cones stand for.
#ifndef HELIODON_CONE_LOBES_GLSL
#define HELIODON_CONE_LOBES_GLSL
#include "passes/cone_trace/volume_shared.h"
#include "shading/bsdf_lobes.h"
#include "shading/lobe_cone.h"

/// Albedos of the lobes; an effect that is switched off has none.
struct ConeLobes {
    vec3 diffuse;
    vec3 specular;
    vec3 coat;
    vec3 refraction;
};

ConeLobes cone_lobes(Surface surface, BsdfLobes lobes, uint effects) {
    ConeLobes result = ConeLobes(vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f));
    if ((effects & gi_effect_diffuse) != 0u) result.diffuse = bsdf_diffuse_albedo_prepared(surface, lobes);
    if ((effects & gi_effect_specular) != 0u) {
        result.specular = bsdf_specular_albedo_prepared(surface, lobes);
        result.coat = vec3(bsdf_coat_albedo_prepared(lobes));
    }
    if ((effects & gi_effect_refraction) != 0u && lobes.glass > 0.0f)
        result.refraction = bsdf_transmission_albedo_prepared(surface, lobes);
    return result;
}

#endif
