#pragma once

#include <span>

#include "passes/inject/inject.h"

namespace heliodon::passes {

/// Bytes of the occupancy of `cascades` of `size` voxels an edge (occupancy_shared.h).
[[nodiscard]] VkDeviceSize occupancy_bytes(std::uint32_t size, std::uint32_t cascades);

/// Which faces each voxel and texel of the texture has, found if it was outdated: the finest ones' by `work`, beside filtering.
struct Occupied {
    graph::BufferHandle faces;
    FinestWork work;
};
[[nodiscard]] Result<Occupied> add_occupied(graph::Graph& graph, gpu::Pipelines& pipelines, std::span<const InjectCascade> cascades,
                                            const VolumeImages& images);
/// The coarse ones', once they are filtered, and how far from each voxel nothing shows itself to cones.
[[nodiscard]] Result<void> add_emptiness(graph::Graph& graph, gpu::Pipelines& pipelines, std::span<const InjectCascade> cascades,
                                         const VolumeImages& images, graph::BufferHandle occupied);

}  // namespace heliodon::passes
