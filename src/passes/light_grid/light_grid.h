#pragma once

#include "core/math.h"
#include "core/result.h"
#include "passes/common/scene_inputs.h"
#include "passes/light_grid/light_grid_shared.h"

namespace heliodon::passes {

/// The grid for a batch of lights in a scene; no cells where lights are so few that none need be picked.
[[nodiscard]] shading::LightGridHeader light_grid_header(const Bounds& scene, std::uint32_t light_first, std::uint32_t light_count);
/// What its buffer holds.
[[nodiscard]] VkDeviceSize light_grid_bytes(const shading::LightGridHeader& header);

/// Fills the sums of `grid`, whose header is there already, from the light table.
[[nodiscard]] Result<void> record_light_grid(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                             const gpu::Buffer& grid, const shading::LightGridHeader& header);

}  // namespace heliodon::passes
