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

/// CIE 1931 XYZ to linear Rec. 709: the inverse of IEC 61966-2-1:1999's matrix, by which Y is the luminance exactly.
SHADING_FN vec3 rgb_from_xyz(vec3 xyz) {
    return vec3(3.2406255f * xyz.x - 1.5372080f * xyz.y - 0.4986286f * xyz.z,
                -0.9689307f * xyz.x + 1.8757561f * xyz.y + 0.0415175f * xyz.z,
                0.0557101f * xyz.x - 0.2040211f * xyz.y + 1.0569959f * xyz.z);
}
/// A colour that Rec. 709 cannot show moves towards the grey of its luminance until it can.
SHADING_FN vec3 into_gamut(vec3 rgb, float luminance) {
    float lowest = min(min(rgb.x, rgb.y), rgb.z);
    if (luminance <= 0.0f) {
        return vec3(0.0f);
    }
    return lowest < 0.0f ? vec3(luminance) + (rgb - vec3(luminance)) * (luminance / (luminance - lowest)) : rgb;
}

/// Hošek & Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance", eq. 8, of three values. Perez, Seals &
/// Michalsky's 1993 formula, which Preetham, Shirley & Smits 1999 fit (eq. 3), is the same with G = I = 0.
SHADING_FN vec3 daylight_values(SHADING_IN(SkyData) sky, vec3 direction) {
    float from_sun = 2.0f * asin(min(0.5f * length(direction - sky.sun_direction), 1.0f));
    float cosine = cos(from_sun);
    vec3 h = vec3(sky.daylight[8]);
    vec3 across = max(vec3(1.0f) + h * h - h * (2.0f * cosine), vec3(1.0e-6f));
    vec3 halo = vec3(1.0f + cosine * cosine) / (across * sqrt(across));  // χ
    vec3 gradation = vec3(1.0f) + vec3(sky.daylight[0]) * exp(vec3(sky.daylight[1]) / max(direction.y + sky.horizon, 1.0e-4f));
    vec3 indicatrix = vec3(sky.daylight[2]) + vec3(sky.daylight[3]) * exp(vec3(sky.daylight[4]) * from_sun) +
                      vec3(sky.daylight[5]) * (cosine * cosine) + vec3(sky.daylight[6]) * halo +
                      vec3(sky.daylight[7]) * sqrt(max(direction.y, 0.0f));
    return gradation * indicatrix;
}
SHADING_FN vec3 daylight_radiance(SHADING_IN(SkyData) sky, vec3 direction) {
    vec3 values = daylight_values(sky, direction);
    if (sky.model == sky_model_preetham) {  // Y, x, y
        float per_y = values.x / values.z;
        values = vec3(values.y * per_y, values.x, (1.0f - values.y - values.z) * per_y);
    }
    values = values * vec3(sky.daylight[9]);
    return sky.luminance + into_gamut(rgb_from_xyz(values), values.y);
}

/// A sky whose luminance is a formula of direction.
SHADING_FN bool sky_is_formula(SHADING_IN(SkyData) sky) {
    return sky.model >= sky_model_cie;
}

/// Radiance in cd/m². `texel` is the image at sky_uv (anything for other models).
SHADING_FN vec3 sky_radiance(SHADING_IN(SkyData) sky, vec3 direction, vec3 texel) {
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
        return sky.ground;
    }
    if (sky.model == sky_model_overcast) {
        return sky.luminance * ((1.0f + 2.0f * direction.y) * (1.0f / 3.0f));  // Moon & Spencer 1942
    }
    if (sky.model != sky_model_cie) {
        return daylight_radiance(sky, direction);
    }
    // The chord keeps the digits of small angles.
    float from_sun = 2.0f * asin(min(0.5f * length(direction - sky.sun_direction), 1.0f));
    vec4 p = sky.gradation_indicatrix;
    return sky.luminance * (cie_gradation(p.x, p.y, direction.y) * cie_indicatrix(p.z, p.w, sky.indicatrix_e, from_sun));
}
/// The same of a mean over directions: `texel` is the mean of the image, or of a formula's own radiance.
SHADING_FN vec3 sky_radiance_filtered(SHADING_IN(SkyData) sky, vec3 texel) {
    if (sky.model == sky_model_none) {
        return vec3(0.0f);
    }
    return sky.model == sky_model_constant ? sky.luminance : (sky.model == sky_model_image ? sky.luminance * texel : texel);
}

SHADING_END
#endif
