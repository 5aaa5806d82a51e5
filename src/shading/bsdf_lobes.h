// What the material models know of one surface from one viewing direction, and their albedos: everything but
// the light's direction. docs/materials.md derives it. Conventions: bsdf.h.
#ifndef HELIODON_SHADING_BSDF_LOBES_H
#define HELIODON_SHADING_BSDF_LOBES_H
#include "shading/fresnel.h"
#include "shading/ggx_albedo.h"
#include "shading/scene_data.h"
SHADING_BEGIN

/// A material at one point, after its textures.
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
    uint model;   // material_model_…
    bool inside;  // the viewer is within the solid: wo.z > 0 looks at the back of a transmissive surface
};

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
    return s;
}

/// What the models need of one surface and one viewing direction.
struct BsdfLobes {
    float alpha;
    float coat_alpha;
    float eta;    // index beyond the surface / index on the viewer's side
    float metal;  // shares of the three substances, together 1
    float dielectric;
    float glass;
    vec3 dielectric_f0;
    float dielectric_f90;
    vec3 glass_specular;
    vec3 transmission_color;
    vec2 split;    // A, B at wo
    float albedo;  // A + B
    float albedo_average;
    vec3 metal_multiple;  // Fresnel terms of the multiple-scattering lobe
    vec3 dielectric_multiple;
    vec3 dielectric_below;  // 1 − specular albedo of the dielectric at wo
    vec3 diffuse;           // base colour / (π · average of dielectric_below)
    float coat_albedo;      // clearcoat · albedo of the coat at wo
    float coat_average;
    float glass_lost;            // 1 − albedo of single scattering in glass at wo
    float glass_through;         // share of the glass's multiple scattering that goes through
    float probability_specular;  // of sampling each lobe
    float probability_diffuse;
    float probability_glass;
    float probability_coat;
    float probability_through;  // the cosine lobe on the far side
};

SHADING_CONST float clearcoat_f0 = 0.04f;  // KHR_materials_clearcoat: index 1.5

SHADING_FN vec3 schlick_albedo(vec3 f0, float f90, vec3 multiple, vec2 split) {
    return f0 * split.x + vec3(f90) * split.y + multiple * (1.0f - split.x - split.y);
}
/// What the dielectric's specular reflection leaves for its base.
SHADING_FN vec3 dielectric_below(BsdfLobes l, vec2 split) {
    return max(vec3(1.0f) - schlick_albedo(l.dielectric_f0, l.dielectric_f90, l.dielectric_multiple, split),
               vec3(0.0f));
}
SHADING_FN float coat_directional_albedo(Surface s, vec2 split) {
    return s.clearcoat * (clearcoat_f0 * split.x + split.y);
}
/// How much of the layers below passes the coat: never more than it lets through either way, so that the
/// sum conserves energy and stays reciprocal, exact over a mirror.
SHADING_FN float coat_transmittance(float coat_albedo_o, float coat_albedo_i) {
    return 1.0f - max(coat_albedo_o, coat_albedo_i);
}

/// An index whose refraction single precision resolves: at 1 every facet sends light straight on and the lobe
/// has no width (1.001 reflects 2.5·10⁻⁷); glTF's 0 stands for "reflects everything".
SHADING_FN float glass_ior(float ior) {
    return abs(ior - 1.0f) < 1.0e-3f ? 1.001f : clamp(ior, 0.01f, 100.0f);
}

/// Share of glass's multiple scattering that is refracted: Kulla & Conty 2017. The two sides' shares are
/// in the ratio that makes refraction reciprocal, (1 − Favg)/(1 − Eavg), scaled so that neither exceeds
/// what Fresnel's average lets through from the thin side, nor 1.
SHADING_FN float glass_multiple_through(float alpha, float eta) {
    float inverse = 1.0f / eta;
    float passed = 1.0f - glass_fresnel_average(eta);
    float passed_back = 1.0f - glass_fresnel_average(inverse);
    float lost = max(1.0f - glass_albedo_average(alpha, eta), 1.0e-6f);
    float lost_back = max(1.0f - glass_albedo_average(alpha, inverse), 1.0e-6f);
    float thin_lost = eta >= 1.0f ? lost : lost_back;
    float scale = min(thin_lost, min(lost / passed, lost_back / passed_back));
    return scale * passed / lost;
}

/// Diffuse part of the directional albedo (what a sky's irradiance/π is multiplied by).
SHADING_FN vec3 bsdf_diffuse_albedo_prepared(Surface s, BsdfLobes l) {
    if (s.model == material_model_unlit) {
        return vec3(0.0f);
    }
    if (s.model == material_model_lambert) {
        return s.base_color;
    }
    return s.base_color * l.dielectric_below * l.dielectric * coat_transmittance(l.coat_albedo, l.coat_average);
}
/// Specular part without the coat's: reflections of the roughness of the surface.
SHADING_FN vec3 bsdf_specular_albedo_prepared(Surface s, BsdfLobes l) {
    if (s.model != material_model_standard) {
        return vec3(0.0f);
    }
    vec3 metal = schlick_albedo(s.base_color, 1.0f, l.metal_multiple, l.split) * l.metal;
    vec3 dielectric = (vec3(1.0f) - l.dielectric_below) * l.dielectric;
    float f0 = f0_from_ior(s.ior);
    vec3 glass = min(l.glass_specular * (f0 * l.split.x + l.split.y), vec3(1.0f)) * l.glass;
    return (metal + dielectric + glass) * (1.0f - l.coat_albedo);
}
/// Reflection of the clear coat, of its own roughness.
SHADING_FN float bsdf_coat_albedo_prepared(BsdfLobes l) {
    return l.coat_albedo;
}
/// What glass lets through.
SHADING_FN vec3 bsdf_transmission_albedo_prepared(Surface s, BsdfLobes l) {
    float f0 = f0_from_ior(s.ior);
    vec3 reflected = min(l.glass_specular * (f0 * l.split.x + l.split.y), vec3(1.0f));
    return (vec3(1.0f) - vec3(max_component(reflected))) * l.transmission_color * l.glass * (1.0f - l.coat_albedo);
}

SHADING_FN void prepare_substances(Surface s, SHADING_INOUT(BsdfLobes) l) {
    l.alpha = ggx_alpha(s.roughness);
    l.coat_alpha = ggx_alpha(s.clearcoat_roughness);
    l.eta = s.inside ? 1.0f / glass_ior(s.ior) : glass_ior(s.ior);
    // Lambertian and unlit surfaces have none; seen from inside, only glass scatters, the rest absorbs.
    float standard = s.model == material_model_standard ? 1.0f : 0.0f;
    float opaque = s.inside ? 0.0f : standard;
    l.metal = opaque * s.metallic;
    l.dielectric = opaque * (1.0f - s.metallic) * (1.0f - s.transmission);
    l.glass = standard * (1.0f - s.metallic) * s.transmission;

    // KHR_materials_specular: F0 scaled by colour and strength, F90 by strength. Without a step in the
    // index there is no interface and nothing to reflect.
    l.dielectric_f0 = min(f0_from_ior(s.ior) * s.specular_color, vec3(1.0f)) * s.specular;
    l.dielectric_f90 = s.ior == 1.0f ? 0.0f : s.specular;
    l.glass_specular = s.specular_color * s.specular;
    // Light crosses a solid's surface twice; each crossing takes the root (Burley 2015, section 5.2).
    l.transmission_color = sqrt(max(s.base_color, vec3(0.0f)));
}

SHADING_FN void prepare_albedos(Surface s, vec3 wo, SHADING_INOUT(BsdfLobes) l) {
    l.split = ggx_albedo_split(wo.z, l.alpha);
    vec2 average = ggx_albedo_split_average(l.alpha);
    l.albedo = l.split.x + l.split.y;
    l.albedo_average = average.x + average.y;
    l.metal_multiple = multiple_scattering_fresnel(fresnel_schlick_average(s.base_color, 1.0f), l.albedo_average);
    l.dielectric_multiple =
        multiple_scattering_fresnel(fresnel_schlick_average(l.dielectric_f0, l.dielectric_f90), l.albedo_average);
    l.dielectric_below = dielectric_below(l, l.split);
    l.diffuse = s.base_color * inverse_pi / max(dielectric_below(l, average), vec3(1.0e-6f));

    if (s.clearcoat > 0.0f && !s.inside) {
        l.coat_albedo = coat_directional_albedo(s, ggx_albedo_split(wo.z, l.coat_alpha));
        l.coat_average = coat_directional_albedo(s, ggx_albedo_split_average(l.coat_alpha));
    }
    if (l.glass > 0.0f) {
        l.glass_lost = 1.0f - glass_albedo(wo.z, l.alpha, l.eta);
        l.glass_through = glass_multiple_through(l.alpha, l.eta);
    }
}

/// Lobes are sampled in proportion to the light they return.
SHADING_FN void prepare_probabilities(Surface s, SHADING_INOUT(BsdfLobes) l) {
    vec3 single = (s.base_color * l.split.x + vec3(l.split.y)) * l.metal +
                  (l.dielectric_f0 * l.split.x + vec3(l.dielectric_f90 * l.split.y)) * l.dielectric;
    vec3 multiple = (l.metal_multiple * l.metal + l.dielectric_multiple * l.dielectric) * (1.0f - l.albedo);
    float below_coat = 1.0f - l.coat_albedo;
    float specular = luminance(single) * below_coat;
    float diffuse = luminance(multiple + s.base_color * l.dielectric_below * l.dielectric) * below_coat +
                    l.glass * l.glass_lost * (1.0f - l.glass_through) * below_coat;
    float through = luminance(l.transmission_color) * l.glass * l.glass_lost * l.glass_through * below_coat;
    float glass = l.glass * (1.0f - l.glass_lost) * below_coat;
    float sum = specular + diffuse + glass + l.coat_albedo + through;
    float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    l.probability_specular = specular * scale;
    l.probability_diffuse = diffuse * scale;
    l.probability_glass = glass * scale;
    l.probability_coat = l.coat_albedo * scale;
    l.probability_through = through * scale;
}

SHADING_FN BsdfLobes bsdf_prepare(Surface s, vec3 wo) {
    BsdfLobes l;
    l.split = vec2(0.0f);
    l.albedo = 0.0f;
    l.albedo_average = 0.0f;
    l.metal_multiple = vec3(0.0f);
    l.dielectric_multiple = vec3(0.0f);
    l.dielectric_below = vec3(0.0f);
    l.diffuse = vec3(0.0f);
    l.coat_albedo = 0.0f;
    l.coat_average = 0.0f;
    l.glass_lost = 0.0f;
    l.glass_through = 0.0f;
    l.probability_specular = 0.0f;
    l.probability_diffuse = s.model == material_model_lambert ? 1.0f : 0.0f;
    l.probability_glass = 0.0f;
    l.probability_coat = 0.0f;
    l.probability_through = 0.0f;
    prepare_substances(s, l);
    if (s.model == material_model_standard) {
        prepare_albedos(s, wo, l);
        prepare_probabilities(s, l);
    }
    return l;
}

SHADING_END
#endif
