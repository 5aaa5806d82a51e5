#pragma once

#include "passes/cone_trace/cone_trace.h"

namespace heliodon::passes {

struct SensorLights {
    std::uint32_t first = 0, count = 0;
    bool sky = false, ambient = false;
};
/// Records the illuminance of `count` SensorData planes under one batch of lights, outside any graph: the
/// shadow maps must be in SHADER_READ_ONLY_OPTIMAL.
[[nodiscard]] Result<void> record_sensors(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                          const LightingInputs& lighting, const gpu::Image& shadow_depth, const gpu::Image& shadow_slope,
                                          const gpu::Buffer& sensors, std::uint32_t count, const SensorLights& lights);
/// Adds indirect light and the sky by cones through the volume, which must be in SHADER_READ_ONLY_OPTIMAL.
[[nodiscard]] Result<void> record_cone_sensors(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                               const VolumeInputs& volume, const gpu::Buffer& sensors, std::uint32_t count);

}  // namespace heliodon::passes
