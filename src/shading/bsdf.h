// The material models: evaluation, density, sampling and albedos. docs/materials.md derives them.
//
// Directions are local: z is the shading normal, turned to the viewer's side, so that wo.z > 0 always
// (the caller flips the frame; for wo.z ≤ 0 everything is 0). wi.z > 0 reflects, wi.z < 0 transmits.
// x is the tangent of surfaces that tell it from others (surface_frame, material_eval.h).
// `wo` points to the viewer, `wi` to the light. Values are for radiance: f(wi → wo) · |cos θi|.
//
// Many lights at one point: call bsdf_prepare once and the …_prepared functions for each light.
#ifndef HELIODON_SHADING_BSDF_H
#define HELIODON_SHADING_BSDF_H
#include "shading/bsdf_lobes.h"
SHADING_BEGIN

struct BsdfSample {
    vec3 direction;   // wi, local
    float pdf;        // per steradian; 0: nothing was sampled, the path ends
    vec3 weight;      // f · |cos θi| / pdf
    float eta_scale;  // the part of the weight that is the 1/eta² of radiance across a boundary, else 1;
                      // Russian roulette should look at weight / eta_scale
    bool transmitted;
};

SHADING_FN float glass_fresnel(SHADING_IN(BsdfLobes) l, float cos_theta) {
    return fresnel_dielectric(cos_theta, l.eta);
}
/// What a film on glass reflects: seen from within as from the direction outside that light refracts to.
SHADING_FN vec3 glass_film(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, float cos_theta) {
    float cosine = cos_theta;
    if (s.inside) {
        cosine = sqrt(max(0.0f, 1.0f - (1.0f - cos_theta * cos_theta) / (l.eta * l.eta)));
    }
    return fresnel_thin_film(cosine, s.film_ior, s.film_thickness_nm, min(l.glass_specular * f0_from_ior(s.ior), vec3(1.0f)));
}
/// Reflectance of glass with KHR_materials_specular's factors; total reflection stays total.
SHADING_FN vec3 glass_reflectance(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, float cos_theta, float fresnel) {
    if (fresnel >= 1.0f) {
        return vec3(1.0f);
    }
    vec3 reflectance = min(l.glass_specular * fresnel, vec3(1.0f));
    if (is_extended(s) && s.iridescence > 0.0f) {
        reflectance = mix(reflectance, glass_film(s, l, cos_theta), s.iridescence);
    }
    return reflectance;
}
/// What it lets through: a tinted reflection takes of all channels alike, a film's colours complement each other.
SHADING_FN vec3 glass_transmittance(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, float cos_theta) {
    vec3 reflected = glass_reflectance(s, l, cos_theta, glass_fresnel(l, cos_theta));
    if (is_extended(s) && s.iridescence > 0.0f) {
        return vec3(1.0f) - reflected;
    }
    return vec3(1.0f - max_component(reflected));
}

/// (1 − E(μo)) (1 − E(μi)) μi / (π (1 − Eavg)) of glass, E of `mu_i` as seen with relative index `eta_i`.
SHADING_FN float glass_multiple(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, float eta_i, float mu_i) {
    if (passes_sheet(s)) {
        vec2 average = ggx_albedo_split_average(l.alpha);
        float lost = max(1.0f - average.x - average.y, 1.0e-6f);
        return l.glass_lost * (1.0f - sheet_albedo(mu_i, l.alpha)) * mu_i * inverse_pi / lost;
    }
    float lost_average = max(1.0f - glass_albedo_average(l.alpha, eta_i), 1.0e-6f);
    return l.glass_lost * (1.0f - glass_albedo(mu_i, l.alpha, eta_i)) * mu_i * inverse_pi / lost_average;
}

SHADING_FN vec3 metal_fresnel(SHADING_IN(Surface) s, float cos_h) {
    if (is_extended(s) && s.conductor) {
        return vec3(fresnel_conductor(cos_h, s.eta.x, s.k.x), fresnel_conductor(cos_h, s.eta.y, s.k.y),
                    fresnel_conductor(cos_h, s.eta.z, s.k.z));
    }
    vec3 fresnel = fresnel_schlick(s.base_color, 1.0f, cos_h);
    if (is_extended(s) && s.iridescence > 0.0f) {
        vec3 film = fresnel_thin_film(cos_h, s.film_ior, s.film_thickness_nm, s.base_color);
        fresnel = mix(fresnel, film, s.iridescence);
    }
    return fresnel;
}
SHADING_FN vec3 dielectric_fresnel(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, float cos_h) {
    if (is_extended(s) && s.iridescence > 0.0f) {
        vec3 film = fresnel_thin_film(cos_h, s.film_ior, s.film_thickness_nm, l.film_base);
        float f90 = s.ior == 1.0f ? 0.0f : s.specular;
        return mix(fresnel_schlick(l.film_base, f90, cos_h), film, s.iridescence);
    }
    return fresnel_schlick(l.dielectric_f0, l.dielectric_f90, cos_h);
}
/// The lobe of metal and dielectric at Fresnel 1.
SHADING_FN float facets_reflection(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec3 wi, vec3 h) {
    if (is_extended(s) && l.stretched) {
        return ggx_reflection_stretched(wo, wi, h, l.alphas);
    }
    return ggx_reflection(wo, wi, h, l.alpha);
}

SHADING_FN vec3 evaluate_reflection(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    float cos_h = dot(wo, h);
    vec3 fresnel = metal_fresnel(s, cos_h) * l.metal + dielectric_fresnel(s, l, cos_h) * l.dielectric;
    vec3 value = vec3(0.0f);
    if (l.glass > 0.0f) {
        vec3 reflected = glass_reflectance(s, l, cos_h, glass_fresnel(l, cos_h)) * l.glass;
        if (is_extended(s) && l.stretched) {
            value = reflected * ggx_reflection(wo, wi, h, l.alpha);  // glass stays as it is along both axes
        } else {
            fresnel += reflected;
        }
    }
    value += fresnel * facets_reflection(s, l, wo, wi, h);

    // Kulla & Conty 2017: (1 − E(μo)) (1 − E(μi)) / (π (1 − Eavg)) returns what single scattering lost.
    vec2 split_i = lobe_split(s, l, wi);
    float lost = (1.0f - l.albedo) * (1.0f - split_i.x - split_i.y) / max(1.0f - l.albedo_average, 1.0e-6f);
    value += (l.metal_multiple * l.metal + l.dielectric_multiple * l.dielectric) * (lost * inverse_pi * wi.z);

    if (l.glass_lost > 0.0f) {
        value += vec3((1.0f - l.glass_through) * l.glass * glass_multiple(s, l, l.eta, wi.z));
    }

    // The same form puts the diffuse base below the dielectric's specular reflection.
    value += l.diffuse * l.dielectric_below * dielectric_below(l, split_i) * (l.dielectric * wi.z);

    if (is_extended(s) && l.sheen_below < 1.0f) {
        value = value * min(l.sheen_below, sheen_transmittance(s, wi.z));
        value += s.sheen_color * sheen_reflection(wo, wi, h, sheen_alpha(s.sheen_roughness));
    }
    if (l.coat_albedo > 0.0f) {
        float coat_i = coat_directional_albedo(s, ggx_albedo_split(wi.z, l.coat_alpha));
        value = value * coat_transmittance(l.coat_albedo, coat_i);
        float coat_fresnel = clearcoat_f0 + (1.0f - clearcoat_f0) * schlick_weight(cos_h);
        value += vec3(s.clearcoat * coat_fresnel * ggx_reflection(wo, wi, h, l.coat_alpha));
    }
    return value;
}

/// Through a sheet: the reflection, turned to the other side.
SHADING_FN vec3 sheet_transmission(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec3 wi) {
    vec3 mirrored = vec3(wi.x, wi.y, -wi.z);
    vec3 h = normalize(wo + mirrored);
    return glass_transmittance(s, l, dot(wo, h)) * ggx_reflection(wo, mirrored, h, l.alpha);
}

SHADING_FN vec3 evaluate_transmission(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec3 wi) {
    if (l.glass <= 0.0f) {
        return vec3(0.0f);
    }
    vec3 single;
    if (passes_sheet(s)) {
        single = sheet_transmission(s, l, wo, wi);
    } else {
        vec3 h = refraction_half_vector(wo, wi, l.eta);
        single = glass_transmittance(s, l, max(dot(wo, h), 0.0f)) * ggx_refraction(wo, wi, h, l.alpha, l.eta);
    }
    float multiple = l.glass_through * glass_multiple(s, l, 1.0f / l.eta, -wi.z) * radiance_scale(s, l);
    vec3 value = l.transmission_color * (single + vec3(multiple)) * l.glass;
    float outside = s.inside ? -wi.z : wo.z;
    if (is_extended(s) && max_component(s.sheen_color) > 0.0f) {  // the sheen and the coat lie outside
        value = value * sheen_transmittance(s, outside);
    }
    if (s.clearcoat > 0.0f) {
        value = value * (1.0f - coat_directional_albedo(s, ggx_albedo_split(outside, l.coat_alpha)));
    }
    return value;
}

SHADING_FN vec3 bsdf_evaluate_prepared(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec3 wi) {
    if (wo.z <= 0.0f || wi.z == 0.0f || s.model == material_model_unlit) {
        return vec3(0.0f);
    }
    if (s.model == material_model_lambert) {
        return s.base_color * (max(wi.z, 0.0f) * inverse_pi);
    }
    if (shading_extended && s.model != material_model_standard) {
        if (wi.z <= 0.0f) {
            return vec3(0.0f);
        }
        if (s.model == material_model_disney) {
            return disney_evaluate(s, l.alphas, l.coat_alpha, wo, wi);
        }
        return s.sigma < 0.0f ? eon_evaluate(s.base_color, s.roughness, wo, wi)
                              : oren_nayar_evaluate(s.base_color, s.sigma, wo, wi);
    }
    if (wi.z > 0.0f) {
        return evaluate_reflection(s, l, wo, wi);
    }
    return evaluate_transmission(s, l, wo, wi);
}

/// Density of the coat's lobe.
SHADING_FN float coat_pdf(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec3 h) {
    if (shading_extended && s.model == material_model_disney) {
        return disney_coat_pdf(wo, h, l.coat_alpha);
    }
    return ggx_reflection_pdf(wo, h, l.coat_alpha);
}

SHADING_FN float reflection_pdf(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec3 wi) {
    float pdf = l.probability_diffuse * cosine_hemisphere_pdf(wi.z);
    vec3 h = normalize(wo + wi);
    float mirrored = 0.0f;
    if (l.glass > 0.0f) {
        mirrored = l.probability_glass * glass_fresnel(l, dot(wo, h));
    }
    bool stretched = is_extended(s) && (l.stretched || s.model == material_model_disney);
    if (stretched) {
        pdf += l.probability_specular * ggx_reflection_pdf_stretched(wo, h, l.alphas);
    } else {
        mirrored += l.probability_specular;
    }
    if (!stretched || mirrored > 0.0f) {
        pdf += mirrored * ggx_reflection_pdf(wo, h, l.alpha);
    }
    if (l.probability_coat > 0.0f) {
        pdf += l.probability_coat * coat_pdf(s, l, wo, h);
    }
    if (is_extended(s)) {
        pdf += l.probability_sheen * uniform_hemisphere_pdf;
    }
    return pdf;
}

SHADING_FN float bsdf_pdf_prepared(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec3 wi) {
    if (wo.z <= 0.0f || wi.z == 0.0f || s.model == material_model_unlit) {
        return 0.0f;
    }
    if (s.model == material_model_lambert || (shading_extended && s.model == material_model_oren_nayar)) {
        return cosine_hemisphere_pdf(wi.z);
    }
    if (wi.z > 0.0f) {
        return reflection_pdf(s, l, wo, wi);
    }
    if (l.glass <= 0.0f) {
        return 0.0f;
    }
    float pdf = l.probability_through * cosine_hemisphere_pdf(-wi.z);
    if (passes_sheet(s)) {
        vec3 h = normalize(wo + vec3(wi.x, wi.y, -wi.z));
        return pdf + l.probability_glass * (1.0f - glass_fresnel(l, dot(wo, h))) * ggx_reflection_pdf(wo, h, l.alpha);
    }
    vec3 h = refraction_half_vector(wo, wi, l.eta);
    float transmittance = 1.0f - glass_fresnel(l, max(dot(wo, h), 0.0f));
    return pdf + l.probability_glass * transmittance * ggx_refraction_pdf(wo, wi, h, l.alpha, l.eta);
}

SHADING_FN vec3 mirrored_about(vec3 wo, vec3 h) {
    return h * (2.0f * dot(wo, h)) - wo;
}
/// A direction of the specular lobe of metal and dielectric.
SHADING_FN vec3 sample_facets(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec2 u) {
    if (is_extended(s) && (l.stretched || s.model == material_model_disney)) {
        return mirrored_about(wo, ggx_sample_visible_normal_stretched(wo, l.alphas, u));
    }
    return mirrored_about(wo, ggx_sample_visible_normal(wo, l.alpha, u));
}
SHADING_FN vec3 sample_coat(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec2 u) {
    if (shading_extended && s.model == material_model_disney) {
        return mirrored_about(wo, disney_sample_coat(l.coat_alpha, u));
    }
    return mirrored_about(wo, ggx_sample_visible_normal(wo, l.coat_alpha, u));
}
/// Of glass: mirrored where `choice` in [0, 1) is less than Fresnel's term, else refracted or, by a sheet, let through.
SHADING_FN vec3 sample_glass(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec2 u, float choice,
                             SHADING_OUT(bool) transmitted) {
    vec3 h = ggx_sample_visible_normal(wo, l.alpha, u);
    vec3 mirrored = mirrored_about(wo, h);
    transmitted = choice >= glass_fresnel(l, dot(wo, h));
    if (!transmitted) {
        return mirrored;
    }
    if (passes_sheet(s)) {
        return vec3(mirrored.x, mirrored.y, -mirrored.z);
    }
    vec3 refracted;
    bool refracts = refract_about(wo, h, l.eta, refracted);
    return refracts ? refracted : vec3(0.0f);
}

/// `u` is uniform in [0, 1)³: x and y choose the direction, z the lobe.
SHADING_FN BsdfSample bsdf_sample_prepared(SHADING_IN(Surface) s, SHADING_IN(BsdfLobes) l, vec3 wo, vec3 u) {
    BsdfSample result;
    result.direction = vec3(0.0f, 0.0f, 1.0f);
    result.pdf = 0.0f;
    result.weight = vec3(0.0f);
    result.eta_scale = 1.0f;
    result.transmitted = false;
    if (wo.z <= 0.0f || s.model == material_model_unlit) {
        return result;
    }
    vec2 v = vec2(u.x, u.y);
    if (s.model == material_model_lambert) {
        result.direction = sample_cosine_hemisphere(v);
        result.pdf = cosine_hemisphere_pdf(result.direction.z);
        result.weight = s.base_color;
        return result;
    }
    float choice = u.z;
    vec3 wi = vec3(0.0f, 0.0f, 1.0f);
    float through = l.probability_diffuse + l.probability_through;
    float coat = through + l.probability_coat;
    float specular = coat + l.probability_specular;
    float glass = specular + l.probability_glass;
    if (choice < through) {
        wi = sample_cosine_hemisphere(v);
        if (choice >= l.probability_diffuse) {
            wi.z = -wi.z;
            result.transmitted = true;
        }
    } else if (choice < coat) {
        wi = sample_coat(s, l, wo, v);
    } else if (choice < specular || l.probability_glass + l.probability_sheen <= 0.0f) {
        wi = sample_facets(s, l, wo, v);
    } else if (choice < glass || l.probability_sheen <= 0.0f) {
        // What is left of the choice decides between reflection and refraction.
        wi = sample_glass(s, l, wo, v, (choice - specular) / l.probability_glass, result.transmitted);
    } else {
        wi = sample_uniform_hemisphere(v);
    }
    // A lobe's directions on the wrong side of the surface are lost.
    if (result.transmitted ? wi.z >= 0.0f : wi.z <= 0.0f) {
        result.transmitted = false;
        return result;
    }
    float pdf = bsdf_pdf_prepared(s, l, wo, wi);
    if (!(pdf > 0.0f)) {
        return result;
    }
    result.direction = wi;
    result.pdf = pdf;
    result.weight = bsdf_evaluate_prepared(s, l, wo, wi) / pdf;
    if (result.transmitted) {
        result.eta_scale = radiance_scale(s, l);
    }
    return result;
}

SHADING_FN vec3 bsdf_evaluate(SHADING_IN(Surface) s, vec3 wo, vec3 wi) {
    return bsdf_evaluate_prepared(s, bsdf_prepare(s, wo), wo, wi);
}
SHADING_FN float bsdf_pdf(SHADING_IN(Surface) s, vec3 wo, vec3 wi) {
    return bsdf_pdf_prepared(s, bsdf_prepare(s, wo), wo, wi);
}
SHADING_FN BsdfSample bsdf_sample(SHADING_IN(Surface) s, vec3 wo, vec3 u) {
    return bsdf_sample_prepared(s, bsdf_prepare(s, wo), wo, u);
}
SHADING_FN vec3 bsdf_diffuse_albedo(SHADING_IN(Surface) s, vec3 wo) {
    return bsdf_diffuse_albedo_prepared(s, bsdf_prepare(s, wo));
}
/// The specular albedo with the coat's, for one environment map of the surface's roughness.
SHADING_FN vec3 bsdf_specular_albedo(SHADING_IN(Surface) s, vec3 wo) {
    BsdfLobes l = bsdf_prepare(s, wo);
    return bsdf_specular_albedo_prepared(s, l) + vec3(bsdf_coat_albedo_prepared(l));
}
/// All the light a surface under an even sky of radiance 1 sends towards `wo` by reflection.
SHADING_FN vec3 bsdf_albedo(SHADING_IN(Surface) s, vec3 wo) {
    return bsdf_diffuse_albedo(s, wo) + bsdf_specular_albedo(s, wo);
}

SHADING_END
#endif
