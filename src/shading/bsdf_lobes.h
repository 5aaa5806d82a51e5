// What the material models know of one surface from one viewing direction, and their albedos: everything but
// the light's direction. docs/materials.md derives it. Conventions: bsdf.h.
#ifndef HELIODON_SHADING_BSDF_LOBES_H
#define HELIODON_SHADING_BSDF_LOBES_H
#include "shading/disney.h"
#include "shading/fresnel.h"
#include "shading/ggx_albedo.h"
#include "shading/oren_nayar.h"
#include "shading/sheen.h"
#include "shading/surface.h"
#include "shading/thin_film.h"
SHADING_BEGIN

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

    // Where is_extended() holds.
    vec2 alphas;        // along the local x and y
    bool stretched;     // they differ
    vec3 metal_f0;      // of the Schlick term that stands for the metal where albedos are asked for
    vec3 film_base;     // normal reflectance of the dielectric under its film
    vec3 film_metal;    // what the film shows of either at wo, as a mirror would
    vec3 film_dielectric;
    float sheen_below;  // 1 − the most that the sheen returns at wo
    float probability_sheen;
};

SHADING_CONST float clearcoat_f0 = 0.04f;  // KHR_materials_clearcoat: index 1.5

SHADING_FN vec3 schlick_albedo(vec3 f0, float f90, vec3 multiple, vec2 split) {
    return f0 * split.x + vec3(f90) * split.y + multiple * (1.0f - split.x - split.y);
}
/// What the dielectric's specular reflection leaves for its base.
SHADING_FN vec3 dielectric_below(SHADING_IN(BsdfLobes) l, vec2 split) {
    return max(vec3(1.0f) - schlick_albedo(l.dielectric_f0, l.dielectric_f90, l.dielectric_multiple, split),
               vec3(0.0f));
}
SHADING_FN float coat_directional_albedo(SHADING_IN(Surface) s, vec2 split) {
    return s.clearcoat * (clearcoat_f0 * split.x + split.y);
}
/// How much of the layers below passes the coat: never more than it lets through either way, so that the
/// sum conserves energy and stays reciprocal, exact over a mirror.
SHADING_FN float coat_transmittance(float coat_albedo_o, float coat_albedo_i) {
    return 1.0f - max(coat_albedo_o, coat_albedo_i);
}
/// What the sheen leaves for the layers below, seen from one direction: KHR_materials_sheen.
SHADING_FN float sheen_transmittance(SHADING_IN(Surface) s, float mu) {
    return 1.0f - max_component(s.sheen_color) * sheen_albedo(mu, s.sheen_roughness);
}

/// (A, B) of the surface's GGX from `w`.
SHADING_FN vec2 lobe_split(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 w) {
    if (is_extended(s) && l.stretched) {
        return stretched_albedo_split(w, l.alphas);
    }
    return ggx_albedo_split(w.z, l.alpha);
}

/// An index whose refraction single precision resolves: at 1 every facet sends light straight on and the lobe
/// has no width (1.001 reflects 2.5·10⁻⁷); glTF's 0 stands for "reflects everything".
SHADING_FN float glass_ior(float ior) {
    return abs(ior - 1.0f) < 1.0e-3f ? 1.001f : clamp(ior, 0.01f, 100.0f);
}
/// Whether what goes through leaves on the other side of a sheet, straight on.
SHADING_FN bool passes_sheet(SHADING_IN(Surface) s) {
    return is_extended(s) && s.thin_walled;
}
/// The 1/eta² of radiance that goes into another medium.
SHADING_FN float radiance_scale(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l) {
    return passes_sheet(s) ? 1.0f : 1.0f / (l.eta * l.eta);
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
SHADING_FN vec3 bsdf_diffuse_albedo_prepared(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l) {
    if (s.model == material_model_unlit) {
        return vec3(0.0f);
    }
    if (s.model == material_model_lambert) {
        return s.base_color;
    }
    if (shading_extended && s.model != material_model_standard) {
        return l.diffuse;
    }
    vec3 albedo = s.base_color * l.dielectric_below * l.dielectric;
    if (is_extended(s)) {
        albedo = albedo * l.sheen_below + s.sheen_color * ((1.0f - l.sheen_below) / max(max_component(s.sheen_color), 1.0e-6f));
    }
    return albedo * coat_transmittance(l.coat_albedo, l.coat_average);
}
/// Specular part without the coat's: reflections of the roughness of the surface.
SHADING_FN vec3 bsdf_specular_albedo_prepared(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l) {
    if (shading_extended && s.model == material_model_disney) {
        return schlick_albedo(l.metal_f0, 1.0f, vec3(0.0f), l.split);
    }
    if (s.model != material_model_standard) {
        return vec3(0.0f);
    }
    vec3 metal_f0 = is_extended(s) ? l.metal_f0 : s.base_color;
    vec3 metal = schlick_albedo(metal_f0, 1.0f, l.metal_multiple, l.split) * l.metal;
    vec3 dielectric = (vec3(1.0f) - l.dielectric_below) * l.dielectric;
    float f0 = f0_from_ior(s.ior);
    vec3 glass = min(l.glass_specular * (f0 * l.split.x + l.split.y), vec3(1.0f)) * l.glass;
    vec3 albedo = metal + dielectric + glass;
    if (is_extended(s)) {
        // The Schlick term bounds a film's reflectance; its colour is that at this angle.
        vec3 film = l.film_metal * l.metal + l.film_dielectric * l.dielectric;
        albedo = mix(albedo, film * l.albedo + glass, s.iridescence) * l.sheen_below;
    }
    return albedo * (1.0f - l.coat_albedo);
}
/// Reflection of the clear coat, of its own roughness.
SHADING_FN float bsdf_coat_albedo_prepared(SHADING_IN(BsdfLobes) l) {
    return l.coat_albedo;
}
/// What glass lets through.
SHADING_FN vec3 bsdf_transmission_albedo_prepared(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l) {
    float f0 = f0_from_ior(s.ior);
    vec3 reflected = min(l.glass_specular * (f0 * l.split.x + l.split.y), vec3(1.0f));
    vec3 albedo = (vec3(1.0f) - vec3(max_component(reflected))) * l.transmission_color * l.glass * (1.0f - l.coat_albedo);
    return is_extended(s) ? albedo * l.sheen_below : albedo;
}

SHADING_FN void prepare_substances(SHADING_IN(Surface) s, SHADING_INOUT(BsdfLobes) l) {
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
    // Light crosses a solid's surface twice; each crossing takes the root (Burley 2015, section 5.2). A sheet is both.
    vec3 tint = max(s.base_color, vec3(0.0f));
    l.transmission_color = passes_sheet(s) ? tint : sqrt(tint);
}

/// A Schlick F0 whose reflectance (F90 = 1) is no less than the film's over `base_f0` at any of six angles.
SHADING_FN vec3 film_schlick_f0(SHADING_IN(Surface) s, vec3 base_f0) {
    vec3 f0 = vec3(0.0f);
    for (uint i = 0u; i < 6u; ++i) {
        float cosine = 1.0f - float(i) * 0.17f;
        float grazing = schlick_weight(cosine);
        vec3 film = fresnel_thin_film(cosine, s.film_ior, s.film_thickness_nm, base_f0);
        f0 = max(f0, (film - vec3(grazing)) / (1.0f - grazing));
    }
    return mix(base_f0, max(f0, base_f0), s.iridescence);
}

/// Before the albedos: they follow from what is found here.
SHADING_FN void prepare_extended(SHADING_IN(Surface) s, vec3 wo, SHADING_INOUT(BsdfLobes) l) {
    l.metal_f0 = s.base_color;
    l.film_base = l.dielectric_f0;
    if (s.anisotropy > 0.0f) {
        // KHR_materials_anisotropy.
        l.alphas = vec2(mix(l.alpha, 1.0f, s.anisotropy * s.anisotropy), l.alpha);
        l.stretched = true;
        l.alpha = sqrt(0.5f * dot(l.alphas, l.alphas));
    }
    if (s.iridescence > 0.0f) {
        l.film_metal = fresnel_thin_film(wo.z, s.film_ior, s.film_thickness_nm, s.base_color);
        l.film_dielectric = fresnel_thin_film(wo.z, s.film_ior, s.film_thickness_nm, l.dielectric_f0);
        l.metal_f0 = film_schlick_f0(s, s.base_color);
        l.dielectric_f0 = film_schlick_f0(s, l.dielectric_f0);
        l.dielectric_f90 = mix(l.dielectric_f90, 1.0f, s.iridescence);
    }
    if (max_component(s.sheen_color) > 0.0f && !s.inside) {
        l.sheen_below = sheen_transmittance(s, wo.z);
    }
}

SHADING_FN float sheet_albedo(float mu, float alpha) {
    vec2 split = ggx_albedo_split(mu, alpha);
    return split.x + split.y;
}

SHADING_FN void prepare_albedos(SHADING_IN(Surface) s, vec3 wo, SHADING_INOUT(BsdfLobes) l) {
    l.split = lobe_split(s, l, wo);
    vec2 average = ggx_albedo_split_average(l.alpha);
    vec3 metal_f0 = s.base_color;
    if (is_extended(s)) {
        metal_f0 = l.metal_f0;
        if (l.stretched) {
            average = stretched_split_average(l.alphas);
        }
    }
    l.albedo = l.split.x + l.split.y;
    l.albedo_average = average.x + average.y;
    vec3 metal_average = fresnel_schlick_average(metal_f0, 1.0f);
    if (is_extended(s) && s.conductor) {
        metal_average = s.conductor_average;
    }
    l.metal_multiple = multiple_scattering_fresnel(metal_average, l.albedo_average);
    l.dielectric_multiple =
        multiple_scattering_fresnel(fresnel_schlick_average(l.dielectric_f0, l.dielectric_f90), l.albedo_average);
    l.dielectric_below = dielectric_below(l, l.split);
    l.diffuse = s.base_color * inverse_pi / max(dielectric_below(l, average), vec3(1.0e-6f));

    if (s.clearcoat > 0.0f && !s.inside) {
        l.coat_albedo = coat_directional_albedo(s, ggx_albedo_split(wo.z, l.coat_alpha));
        l.coat_average = coat_directional_albedo(s, ggx_albedo_split_average(l.coat_alpha));
    }
    if (l.glass > 0.0f) {
        if (passes_sheet(s)) {
            // Reflected or passed on, the facets' light is as much as at Fresnel 1.
            l.glass_lost = 1.0f - sheet_albedo(wo.z, l.alpha);
            l.glass_through = 1.0f - glass_fresnel_average(l.eta);
        } else {
            l.glass_lost = 1.0f - glass_albedo(wo.z, l.alpha, l.eta);
            l.glass_through = glass_multiple_through(l.alpha, l.eta);
        }
    }
}

/// Lobes are sampled in proportion to the light they return.
SHADING_FN void prepare_probabilities(SHADING_IN(Surface) s, SHADING_INOUT(BsdfLobes) l) {
    vec3 metal_f0 = is_extended(s) ? l.metal_f0 : s.base_color;
    vec3 single = (metal_f0 * l.split.x + vec3(l.split.y)) * l.metal +
                  (l.dielectric_f0 * l.split.x + vec3(l.dielectric_f90 * l.split.y)) * l.dielectric;
    vec3 multiple = (l.metal_multiple * l.metal + l.dielectric_multiple * l.dielectric) * (1.0f - l.albedo);
    float below_coat = 1.0f - l.coat_albedo;
    float sheen = 0.0f;
    if (is_extended(s)) {
        sheen = (1.0f - l.sheen_below) * below_coat;
        below_coat = below_coat * l.sheen_below;
    }
    float specular = luminance(single) * below_coat;
    float diffuse = luminance(multiple + s.base_color * l.dielectric_below * l.dielectric) * below_coat +
                    l.glass * l.glass_lost * (1.0f - l.glass_through) * below_coat;
    float through = luminance(l.transmission_color) * l.glass * l.glass_lost * l.glass_through * below_coat;
    float glass = l.glass * (1.0f - l.glass_lost) * below_coat;
    float sum = specular + diffuse + glass + l.coat_albedo + through + sheen;
    float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    l.probability_specular = specular * scale;
    l.probability_diffuse = diffuse * scale;
    l.probability_glass = glass * scale;
    l.probability_coat = l.coat_albedo * scale;
    l.probability_through = through * scale;
    l.probability_sheen = sheen * scale;
}

/// Its albedos are those of GGX and Lambert of like colours: what samples lobes, and the real-time engine's sky, go by.
SHADING_FN void prepare_disney(SHADING_IN(Surface) s, vec3 wo, SHADING_INOUT(BsdfLobes) l) {
    l.alphas = disney_alphas(s.roughness, s.anisotropy);
    l.alpha = min(sqrt(0.5f * dot(l.alphas, l.alphas)), 1.0f);
    l.coat_alpha = disney_coat_alpha(s.clearcoat_gloss);
    l.metal_f0 = disney_f0(s);
    l.split = ggx_albedo_split(wo.z, l.alpha);
    l.diffuse = s.base_color * (1.0f - s.metallic);
    l.coat_albedo = 0.25f * s.clearcoat * mix(clearcoat_f0, 1.0f, schlick_weight(wo.z));
    float specular = luminance(schlick_albedo(l.metal_f0, 1.0f, vec3(0.0f), l.split));
    float diffuse = luminance(l.diffuse) + (1.0f - s.metallic) * s.sheen * 0.1f;
    float scale = 1.0f / max(specular + diffuse + l.coat_albedo, 1.0e-6f);
    l.probability_specular = specular * scale;
    l.probability_diffuse = diffuse * scale;
    l.probability_coat = l.coat_albedo * scale;
}

SHADING_FN vec3 oren_nayar_albedo(SHADING_IN(Surface) s, vec3 wo) {
    return s.sigma < 0.0f ? eon_albedo(s.base_color, s.roughness, wo.z) : s.base_color;
}

SHADING_FN BsdfLobes bsdf_prepare(SHADING_IN(Surface) s, vec3 wo) {
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
    l.probability_sheen = 0.0f;
    l.alphas = vec2(1.0f);
    l.stretched = false;
    l.metal_f0 = vec3(0.0f);
    l.film_base = vec3(0.0f);
    l.film_metal = vec3(0.0f);
    l.film_dielectric = vec3(0.0f);
    l.sheen_below = 1.0f;
    l.alpha = 1.0f;
    l.coat_alpha = 1.0f;
    l.eta = 1.0f;
    l.metal = 0.0f;
    l.dielectric = 0.0f;
    l.glass = 0.0f;
    l.dielectric_f0 = vec3(0.0f);
    l.dielectric_f90 = 0.0f;
    l.glass_specular = vec3(0.0f);
    l.transmission_color = vec3(0.0f);
    if (s.model == material_model_lambert) {
        return l;
    }
    prepare_substances(s, l);
    if (shading_extended && s.model == material_model_disney) {
        prepare_disney(s, wo, l);
    }
    if (shading_extended && s.model == material_model_oren_nayar) {
        l.diffuse = oren_nayar_albedo(s, wo);
        l.probability_diffuse = 1.0f;
    }
    if (s.model == material_model_standard) {
        if (is_extended(s)) {
            prepare_extended(s, wo, l);
        }
        prepare_albedos(s, wo, l);
        prepare_probabilities(s, l);
    }
    return l;
}

SHADING_END
#endif
