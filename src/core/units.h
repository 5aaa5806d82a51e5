// Photometric and colour conversions, written once for C++ and GLSL. Light is linear Rec. 709 scaled so that
// its luminance is in cd/m².
#ifndef HELIODON_CORE_UNITS_H
#define HELIODON_CORE_UNITS_H

#ifdef __cplusplus
#include "core/math.h"
#define UNITS_FN [[nodiscard]] inline
#define UNITS_CONST inline constexpr
namespace heliodon::units {
using glm::clamp;
using glm::dot;
using glm::exp2;
using glm::log2;
using glm::pow;
using glm::vec3;
#else
#define UNITS_FN
#define UNITS_CONST const
#endif

/// Luminance of linear Rec. 709 (ITU-R BT.709-6, item 3.2), by the weights that the whole program uses.
UNITS_CONST vec3 luminance_weights = vec3(0.2126f, 0.7152f, 0.0722f);

/// cd/m² of a linear Rec. 709 colour (lux of an illuminance, cd of an intensity).
UNITS_FN float luminance(vec3 rgb) {
    return dot(rgb, luminance_weights);
}
#ifdef __cplusplus
/// The same where sums are kept in double precision.
[[nodiscard]] inline double luminance(glm::dvec3 rgb) {
    return glm::dot(rgb, glm::dvec3(luminance_weights));
}
#endif

/// EV100 = log2(N²/t · 100/S) (ISO 2720:1974, scaled to ISO 100): f-number, shutter in seconds, ISO speed.
UNITS_FN float ev100_from_camera(float aperture_f, float shutter_s, float iso) {
    return log2(aperture_f * aperture_f / shutter_s * 100.0f / iso);
}

/// Luminance in cd/m² that just saturates the sensor at EV100 0: 78/(100·q) with a lens of q = 0.65 (ISO
/// 12232:2006 saturation speed; Lagarde & de Rousiers 2014, section 5.1.1). At another EV100 it is 2^EV100 times that.
UNITS_CONST float saturation_nits_at_ev100_0 = 1.2f;

/// What a luminance is multiplied by to become a tone curve's input x = L / (1.2 · 2^EV100).
UNITS_FN float exposure_scale(float ev100) {
    return 1.0f / (saturation_nits_at_ev100_0 * exp2(ev100));
}

/// The EV100 at which `luminance_nits` just saturates: the inverse of 1.2 · 2^EV100.
UNITS_FN float ev100_from_saturation_luminance(float luminance_nits) {
    return log2(luminance_nits / saturation_nits_at_ev100_0);
}

/// sRGB transfer function (IEC 61966-2-1:1999, section 4.4), linear [0, 1] to encoded [0, 1]; clamps.
UNITS_FN float srgb_encode(float linear) {
    float x = clamp(linear, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f;
}

/// The inverse of srgb_encode.
UNITS_FN float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : pow((encoded + 0.055f) / 1.055f, 2.4f);
}

#ifdef __cplusplus
}  // namespace heliodon::units
#endif
#undef UNITS_FN
#undef UNITS_CONST
#endif
