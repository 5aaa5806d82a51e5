// Reflectance of a surface under a film whose thickness is some wavelengths: Belcour & Barla 2017, "A Practical Extension
// to Microfacet Theory for the Modeling of Varying Iridescence", unpolarized as KHR_materials_iridescence has it.
#ifndef HELIODON_SHADING_THIN_FILM_H
#define HELIODON_SHADING_THIN_FILM_H
#include "shading/fresnel.h"
#include "shading/sampling.h"
SHADING_BEGIN

/// Linear sRGB of the sensitivities' Fourier transforms at an optical path difference (nm), each channel's phase shifted:
/// their eq. 10 with the Gaussian fits of their supplement (XYZ by wave number, 1/m).
SHADING_FN vec3 film_interference(float path_nm, vec3 shift) {
    float phase = 2.0f * pi * path_nm * 1.0e-9f;
    vec3 height = vec3(5.4856e-13f, 4.4201e-13f, 5.2481e-13f);
    vec3 centre = vec3(1.6810e+06f, 1.7953e+06f, 2.2084e+06f);
    vec3 variance = vec3(4.3278e+09f, 9.3046e+09f, 6.6121e+09f);
    float squared = phase * phase;
    vec3 xyz = height * sqrt(variance * (2.0f * pi)) * cos(centre * phase + shift) * exp(-variance * squared);
    float second = 4.5282e+09f;  // the lesser lobe of X
    xyz.x += 9.7470e-14f * sqrt(2.0f * pi * second) * cos(2.2399e+06f * phase + shift.x) * exp(-second * squared);
    xyz = xyz / 1.0685e-7f;
    return vec3(3.2404542f * xyz.x - 1.5371385f * xyz.y - 0.4985314f * xyz.z,
                -0.9692660f * xyz.x + 1.8760108f * xyz.y + 0.0415560f * xyz.z,
                0.0556434f * xyz.x - 0.2040259f * xyz.y + 1.0572252f * xyz.z);
}

/// Reflectance of a base of normal reflectance `base_f0` (against air) under a film of index `film_ior`, in 0…1 a channel.
SHADING_FN vec3 fresnel_thin_film(float cos_theta, float film_ior, float thickness_nm, vec3 base_f0) {
    // A film much thinner than light's waves is none.
    float ior = mix(1.0f, film_ior, smoothstep(0.0f, 30.0f, thickness_nm));
    float cos2 = 1.0f - (1.0f - cos_theta * cos_theta) / (ior * ior);
    if (cos2 <= 0.0f) {
        return vec3(1.0f);
    }
    float cos_film = sqrt(cos2);
    float outer = fresnel_dielectric(cos_theta, ior);
    // The base's index against air, then its reflectance against the film.
    vec3 root = sqrt(clamp(base_f0, vec3(0.0f), vec3(0.9999f)));
    vec3 base_ior = (vec3(1.0f) + root) / (vec3(1.0f) - root);
    vec3 ratio = (base_ior - vec3(ior)) / (base_ior + vec3(ior));
    vec3 inner = fresnel_schlick(ratio * ratio, 1.0f, cos_film);
    // Half a wave is lost at each step up in index.
    vec3 shift = vec3(ior < 1.0f ? 0.0f : pi) + vec3(base_ior.x < ior ? pi : 0.0f, base_ior.y < ior ? pi : 0.0f,
                                                     base_ior.z < ior ? pi : 0.0f);
    // Airy's series, their eq. 5 to 7.
    float through2 = (1.0f - outer) * (1.0f - outer);
    vec3 both = min(inner * outer, vec3(0.9999f));
    vec3 amplitude = sqrt(both);
    vec3 once = inner * through2 / (vec3(1.0f) - both);
    vec3 sum = vec3(outer) + once;
    vec3 order = once - vec3(1.0f - outer);
    float path_nm = 2.0f * ior * thickness_nm * cos_film;
    for (uint m = 1u; m <= 2u; ++m) {
        order = order * amplitude;
        sum += order * film_interference(float(m) * path_nm, shift * float(m)) * 2.0f;
    }
    return clamp(sum, vec3(0.0f), vec3(1.0f));
}

SHADING_END
#endif
