// A material at one point, after its textures.
#ifndef HELIODON_SHADING_SURFACE_H
#define HELIODON_SHADING_SURFACE_H
#include "shading/scene_data.h"
SHADING_BEGIN

// Whether code for more than the standard model's core is there: materials with material_flag_extended. A pipeline has it
// only where the scene has such a material; without, it compiles and runs as if there were none.
#ifdef __cplusplus
inline constexpr bool shading_extended = true;
#else
layout(constant_id = 9) const bool shading_extended = false;
#endif

struct Surface {
    vec3 base_color;
    float metallic;
    vec3 specular_color;
    float specular;
    float roughness;  // perceptual
    float ior;
    float transmission;
    float clearcoat;
    float clearcoat_roughness;
    uint model;   // material_model_standard, _lambert, _unlit, _disney or _oren_nayar
    bool inside;  // the viewer is within the solid: wo.z > 0 looks at the back of a transmissive surface

    // What follows is read where is_extended() holds, and set to surface_default()'s where nothing else is said.
    bool extended;
    bool thin_walled;  // transmission goes straight through both sides of a sheet
    bool conductor;    // the metal reflects by eta and k
    vec3 tangent;      // world direction of the local x, of any length; 0: any
    float anisotropy;  // α along the tangent is mix(α, 1, anisotropy²); disney: anisotropic
    vec3 sheen_color;
    float sheen_roughness;
    float iridescence;
    float film_ior;
    float film_thickness_nm;
    vec3 eta;  // of the conductor, against air
    vec3 k;
    vec3 conductor_average;  // cosine-weighted average of its reflectance
    float subsurface;        // disney
    float specular_tint;
    float sheen;
    float sheen_tint;
    float clearcoat_gloss;
    float sigma;  // oren_nayar: standard deviation of the facets' slope angle, radians; negative: by roughness
    vec3 absorption;  // within the solid, 1/m
};

SHADING_FN bool is_extended(SHADING_IN(Surface) s) {
    return shading_extended && s.extended;
}

SHADING_FN Surface surface_default() {
    Surface s;
    s.base_color = vec3(0.8f);
    s.metallic = 0.0f;
    s.specular_color = vec3(1.0f);
    s.specular = 1.0f;
    s.roughness = 1.0f;
    s.ior = 1.5f;
    s.transmission = 0.0f;
    s.clearcoat = 0.0f;
    s.clearcoat_roughness = 0.0f;
    s.model = material_model_standard;
    s.inside = false;
    s.extended = false;
    s.thin_walled = false;
    s.conductor = false;
    s.tangent = vec3(0.0f);
    s.anisotropy = 0.0f;
    s.sheen_color = vec3(0.0f);
    s.sheen_roughness = 0.0f;
    s.iridescence = 0.0f;
    s.film_ior = 1.3f;
    s.film_thickness_nm = 0.0f;
    s.eta = vec3(1.0f);
    s.k = vec3(0.0f);
    s.conductor_average = vec3(0.0f);
    s.subsurface = 0.0f;
    s.specular_tint = 0.0f;
    s.sheen = 0.0f;
    s.sheen_tint = 0.5f;
    s.clearcoat_gloss = 1.0f;
    s.sigma = -1.0f;
    s.absorption = vec3(0.0f);
    return s;
}

SHADING_END
#endif
