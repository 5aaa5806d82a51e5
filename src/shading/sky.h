// The sky as a function of direction (world, unit). The includer fetches the image's texel at sky_uv.
#ifndef HELIODON_SHADING_SKY_H
#define HELIODON_SHADING_SKY_H
#include "shading/sampling.h"
#include "shading/scene_data.h"
SHADING_BEGIN

/// Unit direction at `azimuth` (radians clockwise from north seen from above) and `elevation`; at
/// north_rad 0 north is −Z and east +X, and north_rad turns north clockwise.
SHADING_FN vec3 direction_from_azimuth(float azimuth, float elevation, float north_rad) {
    float a = azimuth + north_rad;
    return vec3(sin(a) * cos(elevation), sin(elevation), -cos(a) * cos(elevation));
}

/// Where an equirectangular image sky shows `direction`: u from the left, v from the top (zenith), both
/// in [0, 1]. Its centre column looks north (−Z), to the right of it lies east.
SHADING_FN vec2 sky_uv(vec3 direction, float north_rad) {
    float azimuth = atan(direction.x, -direction.z) - north_rad;
    // atan of the slope, not acos: the poles keep their digits.
    float horizontal = sqrt(direction.x * direction.x + direction.z * direction.z);
    float polar = atan(horizontal, direction.y);
    return vec2(fract(0.5f + azimuth * (0.5f * inverse_pi)), polar * inverse_pi);
}
SHADING_FN vec3 sky_direction(vec2 uv, float north_rad) {
    return direction_from_azimuth((uv.x - 0.5f) * (2.0f * pi), (0.5f - uv.y) * pi, north_rad);
}
/// Density per steradian of a direction whose uv was drawn with density `uv_pdf` on the unit square:
/// dω = 2π² sin(polar) du dv.
SHADING_FN float sky_solid_angle_pdf(float uv_pdf, vec2 uv) {
    float sin_polar = sin(pi * uv.y);
    return sin_polar > 0.0f ? uv_pdf / (2.0f * pi * pi * sin_polar) : 0.0f;
}

/// How luminance falls or rises from the zenith to the horizon: ISO 15469:2004 (CIE S 011), eq. 2 and 3.
SHADING_FN float cie_gradation(float a, float b, float sin_elevation) {
    return sin_elevation > 0.0f ? 1.0f + a * exp(b / sin_elevation) : 1.0f;
}
/// How air scatters light by `angle` (radians) from its way: ISO 15469:2004 (CIE S 011), eq. 4.
SHADING_FN float cie_indicatrix(float c, float d, float e, float angle) {
    float cosine = cos(angle);
    return 1.0f + c * (exp(d * angle) - exp(d * (0.5f * pi))) + e * cosine * cosine;
}

/// A sky whose luminance is a formula of direction.
SHADING_FN bool sky_is_formula(SkyData sky) {
    return sky.model == sky_model_cie || sky.model == sky_model_overcast;
}

/// Radiance in cd/m². `texel` is the image at sky_uv (anything for other models).
SHADING_FN vec3 sky_radiance(SkyData sky, vec3 direction, vec3 texel) {
    if (sky.model == sky_model_constant) {
        return sky.luminance;
    }
    if (sky.model == sky_model_image) {
        return sky.luminance * texel;
    }
    if (!sky_is_formula(sky)) {
        return vec3(0.0f);
    }
    if (direction.y < 0.0f) {
        return vec3(sky.ground_luminance);
    }
    if (sky.model == sky_model_overcast) {
        return sky.luminance * ((1.0f + 2.0f * direction.y) * (1.0f / 3.0f));  // Moon & Spencer 1942
    }
    // The chord keeps the digits of small angles.
    float from_sun = 2.0f * asin(min(0.5f * length(direction - sky.sun_direction), 1.0f));
    vec4 p = sky.gradation_indicatrix;
    return sky.luminance * (cie_gradation(p.x, p.y, direction.y) * cie_indicatrix(p.z, p.w, sky.indicatrix_e, from_sun));
}
/// The same of a mean over directions: `texel` is the mean of the image, or of a formula's own radiance.
SHADING_FN vec3 sky_radiance_filtered(SkyData sky, vec3 texel) {
    if (sky.model == sky_model_none) {
        return vec3(0.0f);
    }
    return sky.model == sky_model_constant ? sky.luminance : (sky.model == sky_model_image ? sky.luminance * texel : texel);
}

SHADING_END
#endif
