// The material models: evaluation, density, sampling and albedos. docs/materials.md derives them.
//
// Directions are local: z is the shading normal, turned to the viewer's side, so that wo.z > 0 always
// (the caller flips the frame; for wo.z ≤ 0 everything is 0). wi.z > 0 reflects, wi.z < 0 transmits.
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

SHADING_FN float glass_fresnel(BsdfLobes l, float cos_theta) {
    return fresnel_dielectric(cos_theta, l.eta);
}
/// Reflectance of glass with KHR_materials_specular's factors; total reflection stays total.
SHADING_FN vec3 glass_reflectance(BsdfLobes l, float fresnel) {
    return fresnel >= 1.0f ? vec3(1.0f) : min(l.glass_specular * fresnel, vec3(1.0f));
}

/// (1 − E(μo)) (1 − E(μi)) μi / (π (1 − Eavg)) of glass, E of `mu_i` as seen with relative index `eta_i`.
SHADING_FN float glass_multiple(BsdfLobes l, float eta_i, float mu_i) {
    float lost_average = max(1.0f - glass_albedo_average(l.alpha, eta_i), 1.0e-6f);
    return l.glass_lost * (1.0f - glass_albedo(mu_i, l.alpha, eta_i)) * mu_i * inverse_pi / lost_average;
}

SHADING_FN vec3 evaluate_reflection(Surface s, BsdfLobes l, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    float cos_h = dot(wo, h);
    vec3 fresnel = fresnel_schlick(s.base_color, 1.0f, cos_h) * l.metal +
                   fresnel_schlick(l.dielectric_f0, l.dielectric_f90, cos_h) * l.dielectric;
    if (l.glass > 0.0f) {
        fresnel += glass_reflectance(l, glass_fresnel(l, cos_h)) * l.glass;
    }
    vec3 value = fresnel * ggx_reflection(wo, wi, h, l.alpha);

    // Kulla & Conty 2017: (1 − E(μo)) (1 − E(μi)) / (π (1 − Eavg)) returns what single scattering lost.
    vec2 split_i = ggx_albedo_split(wi.z, l.alpha);
    float lost = (1.0f - l.albedo) * (1.0f - split_i.x - split_i.y) / max(1.0f - l.albedo_average, 1.0e-6f);
    value += (l.metal_multiple * l.metal + l.dielectric_multiple * l.dielectric) * (lost * inverse_pi * wi.z);

    if (l.glass_lost > 0.0f) {
        value += vec3((1.0f - l.glass_through) * l.glass * glass_multiple(l, l.eta, wi.z));
    }

    // The same form puts the diffuse base below the dielectric's specular reflection.
    value += l.diffuse * l.dielectric_below * dielectric_below(l, split_i) * (l.dielectric * wi.z);

    if (l.coat_albedo > 0.0f) {
        float coat_i = coat_directional_albedo(s, ggx_albedo_split(wi.z, l.coat_alpha));
        value = value * coat_transmittance(l.coat_albedo, coat_i);
        float coat_fresnel = clearcoat_f0 + (1.0f - clearcoat_f0) * schlick_weight(cos_h);
        value += vec3(s.clearcoat * coat_fresnel * ggx_reflection(wo, wi, h, l.coat_alpha));
    }
    return value;
}

SHADING_FN vec3 evaluate_transmission(Surface s, BsdfLobes l, vec3 wo, vec3 wi) {
    if (l.glass <= 0.0f) {
        return vec3(0.0f);
    }
    vec3 h = refraction_half_vector(wo, wi, l.eta);
    float reflected = max_component(glass_reflectance(l, glass_fresnel(l, max(dot(wo, h), 0.0f))));
    float single = (1.0f - reflected) * ggx_refraction(wo, wi, h, l.alpha, l.eta);
    float multiple = l.glass_through * glass_multiple(l, 1.0f / l.eta, -wi.z) / (l.eta * l.eta);
    vec3 value = l.transmission_color * (l.glass * (single + multiple));
    if (s.clearcoat > 0.0f) {  // the coat lies outside
        float mu = s.inside ? -wi.z : wo.z;
        value = value * (1.0f - coat_directional_albedo(s, ggx_albedo_split(mu, l.coat_alpha)));
    }
    return value;
}

SHADING_FN vec3 bsdf_evaluate_prepared(Surface s, BsdfLobes l, vec3 wo, vec3 wi) {
    if (wo.z <= 0.0f || wi.z == 0.0f || s.model == material_model_unlit) {
        return vec3(0.0f);
    }
    if (s.model == material_model_lambert) {
        return s.base_color * (max(wi.z, 0.0f) * inverse_pi);
    }
    if (wi.z > 0.0f) {
        return evaluate_reflection(s, l, wo, wi);
    }
    return evaluate_transmission(s, l, wo, wi);
}

SHADING_FN float bsdf_pdf_prepared(Surface s, BsdfLobes l, vec3 wo, vec3 wi) {
    if (wo.z <= 0.0f || wi.z == 0.0f || s.model == material_model_unlit) {
        return 0.0f;
    }
    if (wi.z > 0.0f) {
        float pdf = l.probability_diffuse * cosine_hemisphere_pdf(wi.z);
        if (s.model == material_model_lambert) {
            return pdf;
        }
        vec3 h = normalize(wo + wi);
        float mirrored = l.probability_specular;
        if (l.glass > 0.0f) {
            mirrored += l.probability_glass * glass_fresnel(l, dot(wo, h));
        }
        pdf += mirrored * ggx_reflection_pdf(wo, h, l.alpha);
        if (l.probability_coat > 0.0f) {
            pdf += l.probability_coat * ggx_reflection_pdf(wo, h, l.coat_alpha);
        }
        return pdf;
    }
    if (l.glass <= 0.0f || s.model == material_model_lambert) {
        return 0.0f;
    }
    vec3 h = refraction_half_vector(wo, wi, l.eta);
    float transmittance = 1.0f - glass_fresnel(l, max(dot(wo, h), 0.0f));
    return l.probability_glass * transmittance * ggx_refraction_pdf(wo, wi, h, l.alpha, l.eta) +
           l.probability_through * cosine_hemisphere_pdf(-wi.z);
}

/// `u` is uniform in [0, 1)³: x and y choose the direction, z the lobe.
SHADING_FN BsdfSample bsdf_sample_prepared(Surface s, BsdfLobes l, vec3 wo, vec3 u) {
    BsdfSample result;
    result.direction = vec3(0.0f, 0.0f, 1.0f);
    result.pdf = 0.0f;
    result.weight = vec3(0.0f);
    result.eta_scale = 1.0f;
    result.transmitted = false;
    if (wo.z <= 0.0f || s.model == material_model_unlit) {
        return result;
    }
    float choice = u.z;
    vec2 v = vec2(u.x, u.y);
    vec3 wi = vec3(0.0f, 0.0f, 1.0f);
    float below_coat = l.probability_diffuse + l.probability_through;
    if (choice < below_coat) {
        wi = sample_cosine_hemisphere(v);
        if (choice >= l.probability_diffuse) {
            wi.z = -wi.z;
            result.transmitted = true;
            result.eta_scale = 1.0f / (l.eta * l.eta);
        }
    } else if (choice < below_coat + l.probability_coat) {
        vec3 h = ggx_sample_visible_normal(wo, l.coat_alpha, v);
        wi = h * (2.0f * dot(wo, h)) - wo;
    } else {
        vec3 h = ggx_sample_visible_normal(wo, l.alpha, v);
        wi = h * (2.0f * dot(wo, h)) - wo;
        float below = below_coat + l.probability_coat + l.probability_specular;
        if (choice >= below && l.probability_glass > 0.0f) {
            // What is left of the choice decides between reflection and refraction.
            float rest = (choice - below) / l.probability_glass;
            if (rest >= glass_fresnel(l, dot(wo, h))) {
                vec3 refracted;
                if (!refract_about(wo, h, l.eta, refracted) || refracted.z >= 0.0f) {
                    return result;
                }
                wi = refracted;
                result.transmitted = true;
                result.eta_scale = 1.0f / (l.eta * l.eta);
            }
        }
    }
    if (!result.transmitted && wi.z <= 0.0f) {
        return result;
    }
    float pdf = bsdf_pdf_prepared(s, l, wo, wi);
    if (!(pdf > 0.0f)) {
        return result;
    }
    result.direction = wi;
    result.pdf = pdf;
    result.weight = bsdf_evaluate_prepared(s, l, wo, wi) / pdf;
    return result;
}

SHADING_FN vec3 bsdf_evaluate(Surface s, vec3 wo, vec3 wi) {
    return bsdf_evaluate_prepared(s, bsdf_prepare(s, wo), wo, wi);
}
SHADING_FN float bsdf_pdf(Surface s, vec3 wo, vec3 wi) {
    return bsdf_pdf_prepared(s, bsdf_prepare(s, wo), wo, wi);
}
SHADING_FN BsdfSample bsdf_sample(Surface s, vec3 wo, vec3 u) {
    return bsdf_sample_prepared(s, bsdf_prepare(s, wo), wo, u);
}
SHADING_FN vec3 bsdf_diffuse_albedo(Surface s, vec3 wo) {
    return bsdf_diffuse_albedo_prepared(s, bsdf_prepare(s, wo));
}
/// The specular albedo with the coat's, for one environment map of the surface's roughness.
SHADING_FN vec3 bsdf_specular_albedo(Surface s, vec3 wo) {
    BsdfLobes l = bsdf_prepare(s, wo);
    return bsdf_specular_albedo_prepared(s, l) + vec3(bsdf_coat_albedo_prepared(l));
}
/// All the light a surface under an even sky of radiance 1 sends towards `wo` by reflection.
SHADING_FN vec3 bsdf_albedo(Surface s, vec3 wo) {
    return bsdf_diffuse_albedo(s, wo) + bsdf_specular_albedo(s, wo);
}

SHADING_END
#endif
