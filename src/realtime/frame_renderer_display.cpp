// FrameRenderer: how the live picture is exposed and toned.
#include "convert/display.h"
#include "realtime/frame_renderer.h"

namespace heliodon::realtime {
namespace {

std::uint32_t exposure_mode(ExposureMode mode) {
    switch (mode) {
        case ExposureMode::camera: return shading::exposure_by_camera;
        case ExposureMode::metered: return shading::exposure_metered;
        case ExposureMode::key: return shading::exposure_by_key;
    }
    return shading::exposure_by_camera;
}

}  // namespace

void FrameRenderer::set_display(const Camera& camera, const FrameSample::Display& display) {
    const DisplaySettings& settings = settings_.display;
    const ExposureSettings& exposure = settings.exposure;
    exposure_.sample_scale = display.sample_scale;
    exposure_.expose = {.mode = exposure_mode(exposure.mode),
                        .camera_ev100 = camera.ev100(),
                        .compensation_ev = exposure.compensation_ev,
                        .pattern = convert::metering_pattern(exposure.pattern),
                        .arithmetic = exposure.arithmetic_mean ? 1u : 0u,
                        .low_percentile = exposure.percentiles.x,
                        .high_percentile = exposure.percentiles.y,
                        .estimate_white = settings.tone.estimate_white ? 1u : 0u,
                        .white = convert::tone_white(settings.tone, {}),
                        .adapts = 1,
                        .seconds = display.seconds,
                        .to_light_s = exposure.to_light_s,
                        .to_dark_s = exposure.to_dark_s};
    const glm::mat3 rows = glm::transpose(convert::white_balance(settings));
    tonemap_ = {.balance_red = glm::vec4(rows[0], 0),
                .balance_green = glm::vec4(rows[1], 0),
                .balance_blue = glm::vec4(rows[2], 0),
                .sample_scale = display.sample_scale,
                .curve = convert::tone_curve(settings.tone.curve)};
}

}  // namespace heliodon::realtime
