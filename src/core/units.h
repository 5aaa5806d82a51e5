#pragma once

#include <cmath>
#include <glm/glm.hpp>

/// Photometric and colour conversions. Light is linear Rec. 709 scaled so that its luminance is in cd/m².
namespace heliodon::units {

/// Luminance of linear Rec. 709 (ITU-R BT.709-6, item 3.2), by the weights that the whole program uses.
inline constexpr glm::vec3 luminance_weights{0.2126f, 0.7152f, 0.0722f};

/// cd/m² of a linear Rec. 709 colour (lux of an illuminance, cd of an intensity).
[[nodiscard]] inline float luminance(glm::vec3 rgb) {
    return luminance_weights.r * rgb.r + luminance_weights.g * rgb.g + luminance_weights.b * rgb.b;
}

/// EV100 = log2(N²/t · 100/S) (ISO 2720:1974, scaled to ISO 100). Aperture as f-number, shutter in seconds.
[[nodiscard]] inline float ev100_from_camera(float aperture_f, float shutter_s, float iso) {
    return std::log2(aperture_f * aperture_f / shutter_s * 100.0f / iso);
}

/// Luminance in cd/m² that just saturates the sensor: 78/(100·q) · 2^EV100 with q = 0.65, that is
/// 1.2 · 2^EV100 (ISO 12232:2006 saturation speed; Lagarde and de Rousiers 2014, section 5.1.1).
[[nodiscard]] inline double saturation_luminance_nits(double ev100) {
    return 1.2 * std::exp2(ev100);
}

/// What a luminance is multiplied by to become a tone curve's input x = L / (1.2 · 2^EV100).
[[nodiscard]] inline float exposure_from_ev100(float ev100) {
    return static_cast<float>(1.0 / saturation_luminance_nits(ev100));
}

/// The EV100 at which `luminance_nits` just saturates: the inverse of saturation_luminance_nits.
[[nodiscard]] inline float ev100_from_saturation_luminance(float luminance_nits) {
    return std::log2(luminance_nits / 1.2f);
}

/// sRGB transfer function (IEC 61966-2-1:1999, section 4.4), linear to encoded, for values in [0, 1].
[[nodiscard]] inline float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// The inverse of srgb_encode.
[[nodiscard]] inline float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace heliodon::units
