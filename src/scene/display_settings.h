#pragma once

#include <cstdint>
#include <optional>

#include "core/math.h"

namespace heliodon {

/// From exposed light to the display's linear [0, 1] (shading/tone.h has the formulas and their sources).
enum class ToneCurve : std::uint8_t { linear, hable, reinhard, aces, aces_narkowicz, agx, neutral };

/// The scene file's `render.tonemap`.
struct ToneSettings {
    ToneCurve curve = ToneCurve::hable;
    /// The exposed value that becomes white, of curves that have one (hable, reinhard); 0: the curve's own.
    float white = 0;
    bool estimate_white = false;  ///< from the picture instead (Reinhard 2002)
    bool operator==(const ToneSettings&) const = default;
};

/// Who sets the exposure: the camera, a light meter on the picture, or the picture's key (Reinhard 2002).
enum class ExposureMode : std::uint8_t { camera, metered, key };
/// What of the picture a meter looks at.
enum class MeteringPattern : std::uint8_t { average, centre, spot };

/// The scene file's `render.exposure`.
struct ExposureSettings {
    ExposureMode mode = ExposureMode::camera;
    MeteringPattern pattern = MeteringPattern::average;
    bool arithmetic_mean = false;   ///< of luminance, instead of its logarithm's
    glm::vec2 percentiles{0, 1};    ///< what is darker and brighter is left out
    float compensation_ev = 0;      ///< stops brighter than the meter says
    float to_light_s = 0.4f;        ///< time constants of a live picture's adaptation
    float to_dark_s = 1.2f;
    bool operator==(const ExposureSettings&) const = default;
};

/// What the scene file's `render` block says about showing light.
struct DisplaySettings {
    ToneSettings tone;
    ExposureSettings exposure;
    /// CIE 1931 chromaticity that shows neutral; none: D65, as it is.
    std::optional<glm::vec2> white_balance;
    bool operator==(const DisplaySettings&) const = default;
};

}  // namespace heliodon
