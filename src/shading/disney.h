// The principled BRDF of Burley 2012, "Physically-Based Shading at Disney" (with its addenda's separate α for the Smith
// terms), formula by formula, in linear colour. It does not conserve energy: docs/materials.md has the numbers.
// Directions are local; x is the tangent.
#ifndef HELIODON_SHADING_DISNEY_H
#define HELIODON_SHADING_DISNEY_H
#include "shading/fresnel.h"
#include "shading/ggx_anisotropic.h"
#include "shading/surface.h"
SHADING_BEGIN

/// Section 5.4: α along the tangent and across it.
SHADING_FN vec2 disney_alphas(float roughness, float anisotropic) {
    float aspect = sqrt(1.0f - 0.9f * anisotropic);
    float alpha = roughness * roughness;
    return vec2(max(alpha / aspect, 0.001f), max(alpha * aspect, 0.001f));
}
/// Section 5.6: from satin to gloss.
SHADING_FN float disney_coat_alpha(float gloss) {
    return mix(0.1f, 0.001f, gloss);
}
SHADING_CONST float disney_coat_masking_alpha = 0.25f;

/// The hue and saturation of the base colour; its luminance by Disney's own weights.
SHADING_FN vec3 disney_tint(vec3 base_color) {
    float value = 0.3f * base_color.x + 0.6f * base_color.y + 0.1f * base_color.z;
    return value > 0.0f ? base_color / value : vec3(1.0f);
}
/// Normal reflectance: section 5.5, 0.08 · specular for what is no metal.
SHADING_FN vec3 disney_f0(Surface s) {
    vec3 tinted = mix(vec3(1.0f), disney_tint(s.base_color), s.specular_tint) * (0.08f * s.specular);
    return mix(tinted, s.base_color, s.metallic);
}

/// Section 5.3: retro-reflection by roughness, and Hanrahan & Krueger's flatter one for subsurface scattering.
SHADING_FN float disney_diffuse(Surface s, vec3 wo, vec3 wi, float cos_h) {
    float at_i = schlick_weight(wi.z);
    float at_o = schlick_weight(wo.z);
    float squared = cos_h * cos_h * s.roughness;
    float retro = mix(1.0f, 0.5f + 2.0f * squared, at_i) * mix(1.0f, 0.5f + 2.0f * squared, at_o);
    float flattened = mix(1.0f, squared, at_i) * mix(1.0f, squared, at_o);
    float subsurface = 1.25f * (flattened * (1.0f / (wi.z + wo.z) - 0.5f) + 0.5f);
    return mix(retro, subsurface, s.subsurface);
}

/// Appendix B.2: D of the coat, generalized Trowbridge-Reitz of exponent 1.
SHADING_FN float disney_coat_distribution(float cos_h, float alpha) {
    float a2 = alpha * alpha;
    return (a2 - 1.0f) * inverse_pi / (log(a2) * (1.0f + (a2 - 1.0f) * cos_h * cos_h));
}
/// G1 / (2 μ) of isotropic GGX.
SHADING_FN float disney_masking(float mu, float alpha) {
    float a2 = alpha * alpha;
    return 1.0f / (mu + sqrt(a2 + mu * mu - a2 * mu * mu));
}
/// The same of stretched GGX.
SHADING_FN float disney_masking_stretched(vec3 w, vec2 alphas) {
    vec2 along = vec2(w.x * alphas.x, w.y * alphas.y);
    return 1.0f / (w.z + sqrt(dot(along, along) + w.z * w.z));
}

/// f · cos θi, both directions above the surface.
SHADING_FN vec3 disney_evaluate(Surface s, vec2 alphas, float coat_alpha, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    float cos_h = dot(wi, h);
    float grazing = schlick_weight(cos_h);
    vec3 sheen = mix(vec3(1.0f), disney_tint(s.base_color), s.sheen_tint) * (s.sheen * grazing);
    vec3 value = (s.base_color * (disney_diffuse(s, wo, wi, cos_h) * inverse_pi) + sheen) * (1.0f - s.metallic);
    float masking = disney_masking_stretched(wo, alphas) * disney_masking_stretched(wi, alphas);
    value += mix(disney_f0(s), vec3(1.0f), grazing) * (masking * ggx_distribution_stretched(h, alphas));
    float coat_masking = disney_masking(wo.z, disney_coat_masking_alpha) * disney_masking(wi.z, disney_coat_masking_alpha);
    float coat = 0.25f * s.clearcoat * mix(0.04f, 1.0f, grazing) * coat_masking;
    value += vec3(coat * disney_coat_distribution(h.z, coat_alpha));
    return value * wi.z;
}

/// A half vector of density D cos θ of the coat: appendix B.2.
SHADING_FN vec3 disney_sample_coat(float alpha, vec2 u) {
    float a2 = alpha * alpha;
    float cos2 = clamp((1.0f - pow(a2, 1.0f - u.y)) / (1.0f - a2), 0.0f, 1.0f);
    float sine = sqrt(1.0f - cos2);
    float phi = 2.0f * pi * u.x;
    return vec3(sine * cos(phi), sine * sin(phi), sqrt(cos2));
}
/// Density per steradian of the direction that it mirrors `wo` to.
SHADING_FN float disney_coat_pdf(vec3 wo, vec3 h, float alpha) {
    return disney_coat_distribution(h.z, alpha) * h.z / (4.0f * max(dot(wo, h), 1.0e-6f));
}

SHADING_END
#endif
