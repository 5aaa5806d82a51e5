#pragma once

#include "core/image.h"
#include "scene/display_settings.h"
#include "shading/metering.h"
#include "shading/tone.h"

namespace heliodon::convert {

/// The curve's number in shaders.
[[nodiscard]] std::uint32_t tone_curve(ToneCurve curve);
/// The pattern's number in shaders.
[[nodiscard]] std::uint32_t metering_pattern(MeteringPattern pattern);
/// The exposed value that becomes white; `metering` counts where it is estimated.
[[nodiscard]] float tone_white(const ToneSettings& tone, const shading::Metering& metering);
/// Linear Rec. 709 to what shows neutral.
[[nodiscard]] glm::mat3 white_balance(const DisplaySettings& settings);

/// What a light meter reads off a picture in cd/m².
[[nodiscard]] shading::Metering meter(const Image& image, const ExposureSettings& settings);
/// The exposure of a picture at rest: what the meter says, or the camera's.
[[nodiscard]] float exposure_ev100(const ExposureSettings& settings, const shading::Metering& metering, float camera_ev100);

/// A display-encoded (sRGB) picture of light in cd/m², exposed at `ev100`.
[[nodiscard]] Image displayed(const Image& light, const DisplaySettings& settings, float ev100);

}  // namespace heliodon::convert
