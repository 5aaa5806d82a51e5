#pragma once

#include "core/math.h"
#include "passes/common/frame_shared.h"
#include "scene/camera.h"

namespace heliodon::realtime {

/// The camera's part of FrameData for one picture size and sample position (`jitter` in pixels, −½ … ½).
[[nodiscard]] shading::FrameData camera_frame(const Camera& camera, const Bounds& scene, int width, int height,
                                              glm::vec2 jitter);

/// Point `index` of `count` of a well-spread set in the unit square, moved by a seed: the Hammersley set for a
/// known count, the R2 sequence (Roberts 2018) for count 0 (endless).
[[nodiscard]] glm::vec2 sample_position(std::uint32_t index, std::uint32_t count, std::uint32_t seed);

}  // namespace heliodon::realtime
