#pragma once

#include <span>

#include "passes/inject/inject.h"

namespace heliodon::passes {

/// Bytes of the occupancy of `cascades` of `size` voxels an edge (occupancy_shared.h).
[[nodiscard]] VkDeviceSize occupancy_bytes(std::uint32_t size, std::uint32_t cascades);

/// If the texture was outdated, finds how far from each voxel nothing shows itself to cones; it has to be filtered by now.
[[nodiscard]] Result<void> add_occupancy(graph::Graph& graph, gpu::Pipelines& pipelines, std::span<const InjectCascade> cascades,
                                         const VolumeImages& images);

}  // namespace heliodon::passes
