// The material models: evaluation, density, sampling and albedos. docs/materials.md derives them.
//
// Directions are local: z is the shading normal, turned to the viewer's side, so that wo.z > 0 always
// (the caller flips the frame; for wo.z ≤ 0 everything is 0). wi.z > 0 reflects, wi.z < 0 transmits.
// `wo` points to the viewer, `wi` to the light. Values are for radiance: f(wi → wo) · |cos θi|.
//
// Many lights at one point: call bsdf_prepare once and the …_prepared functions for each light.
#ifndef HELIODON_SHADING_BSDF_H
#define HELIODON_SHADING_BSDF_H
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
    uint model;  // material_model_…
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

struct BsdfSample {
    vec3 direction;   // wi, local
    float pdf;        // per steradian; 0: nothing was sampled, the path ends
    vec3 weight;      // f · |cos θi| / pdf
    float eta_scale;  // the part of the weight that is the 1/eta² of radiance across a boundary, else 1;
                      // Russian roulette should look at weight / eta_scale
    bool transmitted;
};

/// What the models need of one surface and one viewing direction.
struct BsdfLobes {
    float alpha;
    float coat_alpha;
    float eta;  // index beyond the surface / index on the viewer's side
    float metal;       // shares of the three substances, together 1
    float dielectric;
    float glass;
    vec3 dielectric_f0;
    float dielectric_f90;
    vec3 glass_specular;
    vec3 transmission_color;
    vec2 split;          // A, B at wo
    float albedo;        // A + B
    float albedo_average;
    vec3 metal_multiple;       // Fresnel terms of the multiple-scattering lobe
    vec3 dielectric_multiple;
    vec3 dielectric_below;     // 1 − specular albedo of the dielectric at wo
    vec3 diffuse;              // base colour / (π · average of dielectric_below)
    float coat_albedo;         // clearcoat · albedo of the coat at wo
    float coat_average;
    float glass_lost;           // 1 − albedo of single scattering in glass at wo
    float glass_through;        // share of the glass's multiple scattering that goes through
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
SHADING_FN float bsdf_coat_albedo_prepared(BsdfLobes l) { return l.coat_albedo; }
/// What glass lets through.
SHADING_FN vec3 bsdf_transmission_albedo_prepared(Surface s, BsdfLobes l) {
    float f0 = f0_from_ior(s.ior);
    vec3 reflected = min(l.glass_specular * (f0 * l.split.x + l.split.y), vec3(1.0f));
    return (vec3(1.0f) - vec3(max_component(reflected))) * l.transmission_color * l.glass * (1.0f - l.coat_albedo);
}

SHADING_FN BsdfLobes bsdf_prepare(Surface s, vec3 wo) {
    BsdfLobes l;
    l.alpha = ggx_alpha(s.roughness);
    l.coat_alpha = ggx_alpha(s.clearcoat_roughness);
    l.eta = s.inside ? 1.0f / glass_ior(s.ior) : glass_ior(s.ior);
    // Seen from inside, only glass scatters; the other shares absorb.
    l.metal = s.inside ? 0.0f : s.metallic;
    l.dielectric = s.inside ? 0.0f : (1.0f - s.metallic) * (1.0f - s.transmission);
    l.glass = (1.0f - s.metallic) * s.transmission;

    // KHR_materials_specular: F0 scaled by colour and strength, F90 by strength. Without a step in the
    // index there is no interface and nothing to reflect.
    l.dielectric_f0 = min(f0_from_ior(s.ior) * s.specular_color, vec3(1.0f)) * s.specular;
    l.dielectric_f90 = s.ior == 1.0f ? 0.0f : s.specular;
    l.glass_specular = s.specular_color * s.specular;
    // Light crosses a solid's surface twice; each crossing takes the root (Burley 2015, section 5.2).
    l.transmission_color = sqrt(max(s.base_color, vec3(0.0f)));

    l.split = ggx_albedo_split(wo.z, l.alpha);
    vec2 average = ggx_albedo_split_average(l.alpha);
    l.albedo = l.split.x + l.split.y;
    l.albedo_average = average.x + average.y;
    l.metal_multiple = multiple_scattering_fresnel(fresnel_schlick_average(s.base_color, 1.0f), l.albedo_average);
    l.dielectric_multiple = multiple_scattering_fresnel(
        fresnel_schlick_average(l.dielectric_f0, l.dielectric_f90), l.albedo_average);
    l.dielectric_below =
        max(vec3(1.0f) - schlick_albedo(l.dielectric_f0, l.dielectric_f90, l.dielectric_multiple, l.split), vec3(0.0f));
    vec3 below_average =
        vec3(1.0f) - schlick_albedo(l.dielectric_f0, l.dielectric_f90, l.dielectric_multiple, average);
    l.diffuse = s.base_color * inverse_pi / max(below_average, vec3(1.0e-6f));

    l.coat_albedo = 0.0f;
    l.coat_average = 0.0f;
    if (s.clearcoat > 0.0f && !s.inside) {
        l.coat_albedo = coat_directional_albedo(s, ggx_albedo_split(wo.z, l.coat_alpha));
        l.coat_average = coat_directional_albedo(s, ggx_albedo_split_average(l.coat_alpha));
    }

    l.glass_lost = 0.0f;
    l.glass_through = 0.0f;
    if (l.glass > 0.0f) {
        l.glass_lost = 1.0f - glass_albedo(wo.z, l.alpha, l.eta);
        l.glass_through = glass_multiple_through(l.alpha, l.eta);
    }

    // Lobes are sampled in proportion to the light they return.
    vec3 single = (s.base_color * l.split.x + vec3(l.split.y)) * l.metal +
                  (l.dielectric_f0 * l.split.x + vec3(l.dielectric_f90 * l.split.y)) * l.dielectric;
    vec3 multiple = (l.metal_multiple * l.metal + l.dielectric_multiple * l.dielectric) * (1.0f - l.albedo);
    float below_coat = 1.0f - l.coat_albedo;
    float specular = luminance(single) * below_coat;
    float diffuse = luminance(multiple + s.base_color * l.dielectric_below * l.dielectric) * below_coat +
                    l.glass * l.glass_lost * (1.0f - l.glass_through) * below_coat;
    float through = luminance(l.transmission_color) * l.glass * l.glass_lost * l.glass_through * below_coat;
    float glass = l.glass * (1.0f - l.glass_lost) * below_coat;
    float coat = l.coat_albedo;
    if (s.model != material_model_standard) {
        specular = 0.0f;
        diffuse = s.model == material_model_lambert ? 1.0f : 0.0f;
        glass = 0.0f;
        coat = 0.0f;
        through = 0.0f;
    }
    float sum = specular + diffuse + glass + coat + through;
    float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    l.probability_specular = specular * scale;
    l.probability_diffuse = diffuse * scale;
    l.probability_glass = glass * scale;
    l.probability_coat = coat * scale;
    l.probability_through = through * scale;
    return l;
}

SHADING_FN float glass_fresnel(BsdfLobes l, float cos_theta) { return fresnel_dielectric(cos_theta, l.eta); }
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
    vec3 below_i =
        max(vec3(1.0f) - schlick_albedo(l.dielectric_f0, l.dielectric_f90, l.dielectric_multiple, split_i), vec3(0.0f));
    value += l.diffuse * l.dielectric_below * below_i * (l.dielectric * wi.z);

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
SHADING_FN float bsdf_pdf(Surface s, vec3 wo, vec3 wi) { return bsdf_pdf_prepared(s, bsdf_prepare(s, wo), wo, wi); }
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
SHADING_FN vec3 bsdf_albedo(Surface s, vec3 wo) { return bsdf_diffuse_albedo(s, wo) + bsdf_specular_albedo(s, wo); }

SHADING_END
#endif
