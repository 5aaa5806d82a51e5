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

/// Radiance in cd/m². `texel` is the image at sky_uv (anything for other models).
SHADING_FN vec3 sky_radiance(SkyData sky, vec3 texel) {
    if (sky.model == sky_model_constant) {
        return sky.luminance;
    }
    if (sky.model == sky_model_image) {
        return sky.luminance * texel;
    }
    return vec3(0.0f);
}

SHADING_END
#endif
