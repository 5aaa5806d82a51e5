// Fresnel reflectance of unpolarized light.
#ifndef HELIODON_SHADING_FRESNEL_H
#define HELIODON_SHADING_FRESNEL_H
#include "shading/language.h"
SHADING_BEGIN

/// Reflectance at normal incidence between vacuum and index `ior`: ((n − 1)/(n + 1))².
SHADING_FN float f0_from_ior(float ior) {
    float r = (ior - 1.0f) / (ior + 1.0f);
    return r * r;
}

/// (1 − cos θ)⁵
SHADING_FN float schlick_weight(float cos_theta) {
    float m = clamp(1.0f - cos_theta, 0.0f, 1.0f);
    float m2 = m * m;
    return m2 * m2 * m;
}
/// Schlick 1994, eq. 15, with the reflectance at grazing angle free.
SHADING_FN vec3 fresnel_schlick(vec3 f0, float f90, float cos_theta) {
    return f0 + (vec3(f90) - f0) * schlick_weight(cos_theta);
}
/// Its cosine-weighted average over the hemisphere: 2 ∫ (1 − μ)⁵ μ dμ = 1/21.
SHADING_FN vec3 fresnel_schlick_average(vec3 f0, float f90) {
    return f0 + (vec3(f90) - f0) * (1.0f / 21.0f);
}

/// Exact dielectric; `eta` = index beyond the surface / index on the side of the incident ray, whose
/// cosine is `cos_theta` ≥ 0. 1 under total internal reflection. Fresnel 1823 in the form of Walter et
/// al. 2007, eq. 22, which cancels less than the textbook form.
SHADING_FN float fresnel_dielectric(float cos_theta, float eta) {
    float c = clamp(cos_theta, 0.0f, 1.0f);
    float g2 = eta * eta - 1.0f + c * c;
    if (g2 <= 0.0f) {
        return 1.0f;
    }
    float g = sqrt(g2);
    float a = (g - c) / (g + c);
    float b = (c * (g + c) - 1.0f) / (c * (g - c) + 1.0f);
    return 0.5f * a * a * (1.0f + b * b);
}

/// Exact conductor with complex index n + ik against vacuum: Born & Wolf, Principles of Optics, 14.2.
SHADING_FN float fresnel_conductor(float cos_theta, float n, float k) {
    float c = clamp(cos_theta, 0.0f, 1.0f);
    float c2 = c * c;
    float s2 = 1.0f - c2;
    float t0 = n * n - k * k - s2;
    float a2_plus_b2 = sqrt(t0 * t0 + 4.0f * n * n * k * k);
    float a = sqrt(max(0.0f, 0.5f * (a2_plus_b2 + t0)));
    float rs_sum = a2_plus_b2 + c2;
    float rs = (rs_sum - 2.0f * a * c) / (rs_sum + 2.0f * a * c);
    float rp_sum = c2 * a2_plus_b2 + s2 * s2;
    float rp_cross = 2.0f * a * c * s2;
    float rp = rs * (rp_sum - rp_cross) / (rp_sum + rp_cross);
    return 0.5f * (rs + rp);
}

SHADING_END
#endif
