// What both languages compute for case `i`: every header of the shading room on pseudo-random input.
#ifndef HELIODON_TESTS_AGREEMENT_CASE_H
#define HELIODON_TESTS_AGREEMENT_CASE_H
#include "shading/lobe_cone.h"
#include "shading/luminaire_shape.h"
#include "shading/material_eval.h"
#include "shading/octahedral.h"
#include "shading/random.h"
#include "shading/reflected_light.h"
#include "shading/sky.h"
#include "shading/tone.h"
SHADING_BEGIN

SHADING_CONST uint agreement_values = 30u;  // vec4 a case
SHADING_CONST uint agreement_sky_value = 26u;

SHADING_FN Surface agreement_surface(uint i) {
    vec4 a = random4(i, 0u, 0u, 1u);
    vec4 b = random4(i, 0u, 1u, 1u);
    vec4 c = random4(i, 0u, 2u, 1u);
    Surface s = surface_default();
    s.base_color = vec3(a);
    s.metallic = i % 3u == 0u ? 0.0f : a.w;
    s.roughness = 0.1f + 0.9f * b.x;
    s.ior = 1.1f + 1.5f * b.y;
    s.transmission = i % 2u == 0u ? b.z : 0.0f;
    s.specular = b.w;
    s.specular_color = vec3(c);
    s.clearcoat = i % 5u == 0u ? c.w : 0.0f;
    s.clearcoat_roughness = 0.3f;
    s.model = i % 11u == 0u ? material_model_lambert : material_model_standard;
    s.inside = i % 4u == 0u;
    return s;
}
/// Each formula in turn; coefficients of the size that daylight has.
SHADING_FN SkyData agreement_sky(uint i) {
    vec4 a = random4(i, 3u, 0u, 1u);
    vec4 b = random4(i, 3u, 1u, 1u);
    SkyData s;
    s.model = sky_model_cie + i % 4u;
    s.luminance = vec3(a);
    s.horizon = i % 2u == 0u ? 0.01f : 0.0f;
    s.indicatrix_e = b.x;
    s.gradation_indicatrix = vec4(-a.x, -0.1f - a.y, 20.0f * a.z, -3.0f);
    s.sun_direction = normalize(vec3(b.y - 0.5f, b.z, b.w - 0.5f));
    s.ground = vec3(b);
    s.daylight[0] = vec4(-1.1f * a.x);
    s.daylight[1] = -0.1f - a;
    s.daylight[2] = 0.5f + b;
    s.daylight[3] = 8.0f * a;
    s.daylight[4] = -4.0f * b;
    s.daylight[5] = a;
    s.daylight[6] = 0.2f * b;
    s.daylight[7] = a;
    s.daylight[8] = 0.3f + 0.5f * b;
    s.daylight[9] = 0.5f + a;
    return s;
}
/// Of what a pipeline has only where shading_extended says so.
SHADING_FN Surface agreement_extended_surface(uint i) {
    vec4 a = random4(i, 2u, 0u, 1u);
    vec4 b = random4(i, 2u, 1u, 1u);
    vec4 c = random4(i, 2u, 2u, 1u);
    Surface s = agreement_surface(i);
    uint kind = i % 8u;
    s.extended = true;
    s.model = kind == 0u ? material_model_disney : (kind == 1u ? material_model_oren_nayar : material_model_standard);
    s.roughness = 0.3f + 0.7f * b.w;
    s.clearcoat_gloss = 0.2f * c.w;
    s.subsurface = a.x;
    s.specular_tint = a.y;
    s.sheen = a.z;
    s.sigma = a.w < 0.5f ? -1.0f : a.w;
    s.anisotropy = kind == 2u || kind == 0u ? a.x : 0.0f;
    s.sheen_color = kind == 3u ? vec3(a) : vec3(0.0f);
    s.sheen_roughness = 0.2f + 0.8f * a.w;
    s.iridescence = kind == 4u ? a.x : 0.0f;
    s.film_ior = 1.1f + a.y;
    s.film_thickness_nm = 800.0f * a.z;
    s.conductor = kind == 5u;
    s.eta = vec3(b) + vec3(0.1f);
    s.k = vec3(c) * 4.0f;
    s.conductor_average = vec3(0.5f);
    s.thin_walled = kind == 6u;
    s.inside = s.inside && !s.thin_walled && s.model == material_model_standard && s.transmission > 0.0f;
    return s;
}
SHADING_FN vec3 agreement_direction(vec2 u) {
    vec3 w = sample_uniform_hemisphere(u);
    return normalize(vec3(w.x, w.y, max(w.z, 0.05f)));
}
SHADING_FN LightData agreement_light(uint i) {
    vec4 a = random4(i, 0u, 3u, 1u);
    vec4 b = random4(i, 0u, 4u, 1u);
    LightData light;
    light.type = i % 4u;
    light.position = vec3(a) * 3.0f + vec3(2.0f);
    light.radius = i % 3u == 0u ? 0.0f : 0.1f + 0.5f * a.w;
    light.axis = sample_uniform_sphere(vec2(b));
    light.intensity = vec3(100.0f, 50.0f, 20.0f) * b.z;
    light.cos_inner = 0.9f;
    light.cos_outer = -0.5f;
    light.shadow = 0u;
    light.cone_radius = 0.0f;
    light.flux_factor = 0.0f;
    return light;
}

/// A table of 4 polar angles and 3 azimuths.
SHADING_FN float luminaire_value(uint i) {
    if (i < 2u) {
        return i == 0u ? 4.0f : 3.0f;
    }
    if (i < 6u) {
        return float(i - 2u) * (pi / 3.0f);
    }
    if (i < 9u) {
        return float(i - 6u) * pi;
    }
    return 0.1f * float(i % 7u);
}
#include "shading/luminaire.h"

SHADING_FN LightData agreement_luminaire(uint i) {
    LightData light = agreement_light(i);
    vec4 a = random4(i, 0u, 5u, 1u);
    light.type = light_type_luminaire;
    light.tangent = frame_from_normal(light.axis).tangent;
    light.table = 0u;
    light.half_extent = vec3(a) * 0.5f + vec3(0.1f);
    light.opening = i % 5u;
    if (i % 3u == 0u && light.opening == opening_box) {
        light.half_extent.z = 0.0f;
    }
    light.weighted_normal = vec3(0.0f);
    light.radius = i % 7u == 0u ? 0.0f : length(light.half_extent);
    light.face_weights = 9u | (4u << 5u) | (7u << 10u) | (2u << 15u) | (31u << 20u) | (5u << 25u);
    return light;
}

/// Value `k` of case `i`.
SHADING_FN vec4 agreement_value(uint i, uint k) {
    vec4 u = random4(i, 1u, 0u, 1u);
    vec4 v = random4(i, 1u, 1u, 1u);
    Surface s = agreement_surface(i);
    vec3 wo = agreement_direction(vec2(u));
    vec3 wi = agreement_direction(vec2(u.z, u.w));
    if (i % 7u == 0u) {
        wi.z = -wi.z;
    }
    if (k == 0u) {
        return vec4(bsdf_evaluate(s, wo, wi), bsdf_pdf(s, wo, wi));
    }
    if (k == 1u || k == 2u) {
        BsdfSample sampled = bsdf_sample(s, wo, vec3(v));
        return k == 1u ? vec4(sampled.direction, sampled.eta_scale) : vec4(sampled.weight, sampled.pdf);
    }
    if (k == 3u) {
        return vec4(bsdf_diffuse_albedo(s, wo), ggx_albedo_split(v.x, v.y).x);
    }
    if (k == 4u) {
        return vec4(bsdf_specular_albedo(s, wo), glass_albedo(v.x, 0.1f + 0.9f * v.y, 0.5f + v.z));
    }
    if (k == 5u || k == 6u) {
        LightSample sampled = light_sample(agreement_light(i), vec3(0.3f, -0.2f, 0.1f), vec2(v));
        return k == 5u ? vec4(sampled.direction, sampled.distance) : vec4(sampled.value, sampled.pdf);
    }
    if (k == 7u) {
        vec3 w = sample_uniform_sphere(vec2(v));
        vec2 uv = sky_uv(w, 0.3f);
        return vec4(sky_direction(uv, 0.3f), uv.x);
    }
    if (k == 8u) {
        return vec4(tone_map(i % 7u, 4.0f, vec3(v) * 5.0f), srgb_encode(v.w));
    }
    if (k == 9u) {
        vec3 w = sample_uniform_sphere(vec2(v));
        vec2 e = octahedral_encode(w);
        return vec4(octahedral_decode(e), e.x);
    }
    if (k == 10u) {
        PrefilterSample sampled = prefilter_sample(hammersley(i, 4096u), 0.1f + 0.9f * v.x);
        return vec4(sampled.direction, sampled.weight);
    }
    if (k == 11u) {
        return vec4(fresnel_dielectric(v.x, 0.4f + 2.0f * v.y), fresnel_conductor(v.x, 0.2f + v.z, 3.0f * v.w),
                    exposure_scale(10.0f * v.x), ev100_from_camera(1.0f + 10.0f * v.x, 0.01f, 100.0f));
    }
    if (k == 12u) {
        vec3 n = normalize(vec3(v.x - 0.5f, v.y - 0.5f, 0.4f));
        return vec4(usable_shading_normal(n, vec3(0.0f, 0.0f, 1.0f), wo), same_side(wi, wo, wi.z));
    }
    if (k == 13u) {
        vec3 n = frame_from_normal(wo).tangent;
        return vec4(perturb_normal_map(n, vec4(wi, -1.0f), vec3(v), 0.7f), u.x);
    }
    if (k == 14u) {
        Frame frame = frame_from_normal(wo);
        return vec4(perturb_bump(wo, frame.tangent + wo * 0.1f, frame.bitangent * v.w, v.x, v.y),
                    sample_disk(vec2(v)).x);
    }
    if (k == 15u) {
        vec3 weight;
        Cone cone = reflection_cone(wo, 0.01f + 0.9f * v.x, vec3(0.05f + 0.9f * v.y), vec2(u), i % 2u == 0u ? 1.0f : 0.25f, weight);
        return vec4(cone.direction * (0.1f + weight.x), cone.one_minus_cos);
    }
    if (k == 16u) {
        Cone cone = diffuse_cone(i % 9u, i % 4u, 4u, vec2(v), 0.5f);
        return vec4(cone.direction, cone.tan_half_angle);
    }
    if (k == 17u) {
        // Into the denser side: towards the thinner, a facet at the critical angle may fall to either side.
        Cone cone;
        bool refracts = refraction_cone(wo, 0.01f + 0.9f * v.x, 1.1f + v.y, cone);
        return vec4(cone.direction, refracts ? cone.one_minus_cos : -1.0f);
    }
    if (k == 18u) {
        LightData light = agreement_light(i);
        return vec4(light_cone_tan(light, vec3(0.3f, -0.2f, 0.1f)));
    }
    if (k == 19u || k == 20u) {
        LightSample sampled = any_light_sample(agreement_luminaire(i), vec3(0.3f, -0.2f, 0.1f), vec2(v));
        return k == 19u ? vec4(sampled.direction, sampled.distance) : vec4(sampled.value, 1.0f / (1.0f + sampled.pdf));
    }
    if (k == 21u) {
        // Towards the middle: at an edge a ray may meet it or not.
        LightData light = agreement_luminaire(i);
        vec3 from = vec3(0.3f, -0.2f, 0.1f);
        vec3 towards = normalize(light.position - from);
        return vec4(any_light_radiance(light, towards) * 0.01f, any_light_intersect(light, from, towards));
    }
    if (k == 22u) {
        LightData light = agreement_luminaire(i);
        OpeningPoint point = opening_surface_point(light.opening, light.half_extent, light.face_weights, vec2(v));
        return vec4(point.position + point.weighted_normal, opening_projected_area(light.opening, light.half_extent, wi));
    }
    if (k == 23u) {
        Surface extended = agreement_extended_surface(i);
        return vec4(bsdf_evaluate(extended, wo, wi), bsdf_pdf(extended, wo, wi));
    }
    if (k == 24u || k == 25u) {
        BsdfSample sampled = bsdf_sample(agreement_extended_surface(i), wo, vec3(v));
        return k == 24u ? vec4(sampled.direction, sampled.eta_scale) : vec4(sampled.weight, sampled.pdf);
    }
    if (k == agreement_sky_value) {
        return vec4(sky_radiance(agreement_sky(i), sample_uniform_sphere(vec2(v)), vec3(1.0f)), v.z);
    }
    if (k == 27u) {
        return vec4(into_gamut(rgb_from_xyz(vec3(v)), v.y), limb_darkening(v.w));
    }
    if (k == 28u || k == 29u) {
        vec3 albedo = vec3(v);
        ReflectedLight light = reflected_light(albedo, v.w * (albedo.x + albedo.y + albedo.z) * (1.0f / 3.0f), 0.01f + 0.9f * u.z, wo);
        float concentration = lobe_through_cone(lobe_concentration(length(light.mean)), 0.1f);
        return k == 28u ? vec4(light.mean, light.clamped_cosine)
                        : vec4(light.diffuse + light.specular, lobe_density(concentration, wi.z) * lobe_clamped_cosine(concentration, wo.z));
    }
    return v;
}

SHADING_END
#endif
