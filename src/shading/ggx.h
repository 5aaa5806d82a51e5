// The isotropic GGX microfacet distribution (Trowbridge & Reitz 1975; Walter et al. 2007) with Smith
// masking. Directions are local, z = normal; `wo`.z > 0.
#ifndef HELIODON_SHADING_GGX_H
#define HELIODON_SHADING_GGX_H
#include "shading/sampling.h"
SHADING_BEGIN

/// The smoothest surface: at α = 0.001 a highlight is 0.1° wide, less than a pixel of a usual camera,
/// and single precision still resolves the distribution to 10⁻⁴ (a half vector is known to 6·10⁻⁸).
SHADING_CONST float ggx_smallest_alpha = 1.0e-3f;

/// α = perceptual roughness² (Burley 2012), no smaller than ggx_smallest_alpha.
SHADING_FN float ggx_alpha(float roughness) {
    return clamp(roughness * roughness, ggx_smallest_alpha, 1.0f);
}

/// D(h), per steradian: Walter et al. 2007, eq. 33, written in sines so that small α keeps its digits.
SHADING_FN float ggx_distribution(vec3 h, float alpha) {
    float k = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z;
    return inverse_pi / (alpha * alpha * k * k);
}

/// Λ(μ): Heitz 2014, eq. 72; `mu` = |cos θ|.
SHADING_FN float ggx_lambda(float mu, float alpha) {
    float c2 = max(mu * mu, 1.0e-12f);
    float tan2 = max(1.0f - c2, 0.0f) / c2;
    // (√(1 + x) − 1)/2 = x / (2 (√(1 + x) + 1)), without cancellation
    float x = alpha * alpha * tan2;
    return 0.5f * x / (sqrt(1.0f + x) + 1.0f);
}
/// Smith masking of one direction.
SHADING_FN float ggx_g1(float mu, float alpha) {
    return 1.0f / (1.0f + ggx_lambda(mu, alpha));
}
/// Height-correlated masking and shadowing on one side: Heitz 2014, eq. 99.
SHADING_FN float ggx_g2(float mu_o, float mu_i, float alpha) {
    return 1.0f / (1.0f + ggx_lambda(mu_o, alpha) + ggx_lambda(mu_i, alpha));
}

/// A visible normal from a point of the spherical cap: `stretched` = ggx_stretch(wo), `depth` in [0, 1] from
/// the cap's pole to its rim. Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3.
SHADING_FN vec3 ggx_cap_normal(vec3 stretched, float alpha, float depth, float cos_phi, float sin_phi) {
    float t = depth * (1.0f + stretched.z);  // 1 − z, kept for its digits
    float r = sqrt(max(0.0f, t * (2.0f - t)));
    // z = 1 − t + stretched.z = (1 − depth)(1 + stretched.z)
    float z = (1.0f - depth) * (1.0f + stretched.z);
    return normalize(vec3(alpha * (r * cos_phi + stretched.x), alpha * (r * sin_phi + stretched.y), max(z, 1.0e-12f)));
}
SHADING_FN vec3 ggx_stretch(vec3 wo, float alpha) {
    return normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
}
/// A half vector distributed as the normals visible from `wo`.
SHADING_FN vec3 ggx_sample_visible_normal(vec3 wo, float alpha, vec2 u) {
    float phi = 2.0f * pi * u.x;
    return ggx_cap_normal(ggx_stretch(wo, alpha), alpha, u.y, cos(phi), sin(phi));
}
/// Density of the visible normals per steradian of h: Heitz 2018, eq. 1.
SHADING_FN float ggx_visible_normal_pdf(vec3 wo, vec3 h, float alpha) {
    return ggx_g1(wo.z, alpha) * ggx_distribution(h, alpha) * max(dot(wo, h), 0.0f) / wo.z;
}

/// D G2/(4 μo) of Cook & Torrance 1982: the reflection lobe f · cos θi at Fresnel 1.
SHADING_FN float ggx_reflection(vec3 wo, vec3 wi, vec3 h, float alpha) {
    return ggx_distribution(h, alpha) * ggx_g2(wo.z, wi.z, alpha) / (4.0f * wo.z);
}
/// Density per steradian of wi when h comes from ggx_sample_visible_normal and wi mirrors wo about it;
/// the wo·h of the visible normals cancels that of the reflection's Jacobian 1/(4 wo·h).
SHADING_FN float ggx_reflection_pdf(vec3 wo, vec3 h, float alpha) {
    return ggx_g1(wo.z, alpha) * ggx_distribution(h, alpha) / (4.0f * wo.z);
}

/// The half vector of a refraction from `wi` (z < 0) to `wo`, on wo's side: Walter et al. 2007, eq. 16;
/// `eta` = index on wi's side / index on wo's side.
SHADING_FN vec3 refraction_half_vector(vec3 wo, vec3 wi, float eta) {
    vec3 h = wo + wi * eta;
    float squared = dot(h, h);
    if (squared < 1.0e-20f) {
        return vec3(0.0f, 0.0f, 1.0f);  // eta = 1 and straight through: every h refracts so
    }
    h = h * inversesqrt(squared);
    return h.z < 0.0f ? -h : h;
}

/// `wo` refracted at the facet `h` (Snell); false under total internal reflection.
SHADING_FN bool refract_about(vec3 wo, vec3 h, float eta, SHADING_OUT(vec3) wi) {
    float cos_o = dot(wo, h);
    float sin2_i = max(0.0f, 1.0f - cos_o * cos_o) / (eta * eta);
    wi = vec3(0.0f, 0.0f, -1.0f);
    if (sin2_i >= 1.0f) {
        return false;
    }
    float cos_i = sqrt(1.0f - sin2_i);
    wi = h * (cos_o / eta - cos_i) - wo * (1.0f / eta);
    return true;
}

/// The refraction lobe f · |cos θi| at transmittance 1, for radiance (it is multiplied by 1/eta² when
/// light enters wo's medium from wi's): Walter et al. 2007, eq. 21, with separable Smith masking.
SHADING_FN float ggx_refraction(vec3 wo, vec3 wi, vec3 h, float alpha, float eta) {
    float o = dot(wo, h);
    float i = dot(wi, h);
    if (o <= 0.0f || i >= 0.0f) {
        return 0.0f;
    }
    float denominator = eta * i + o;
    return ggx_distribution(h, alpha) * ggx_g1(wo.z, alpha) * ggx_g1(-wi.z, alpha) * o * -i /
           (wo.z * max(denominator * denominator, 1.0e-12f));
}
/// Density per steradian of wi when h comes from ggx_sample_visible_normal: Walter et al. 2007, eq. 17.
SHADING_FN float ggx_refraction_pdf(vec3 wo, vec3 wi, vec3 h, float alpha, float eta) {
    float o = dot(wo, h);
    float i = dot(wi, h);
    if (o <= 0.0f || i >= 0.0f) {
        return 0.0f;
    }
    float denominator = eta * i + o;
    return ggx_visible_normal_pdf(wo, h, alpha) * eta * eta * -i / max(denominator * denominator, 1.0e-12f);
}

SHADING_END
#endif
