#pragma once

#include "gpu/pipeline.h"
#include "graph/executor.h"
#include "passes/common/volume_inputs.h"

namespace heliodon::passes {

/// Words of the sizes of empty cubes in a volume of `size` voxels an edge.
[[nodiscard]] std::uint32_t empty_cube_words(std::uint32_t size);

/// If the volume is `outdated`, finds for each cell and octant the largest cube of cells in which a cone that goes there
/// meets nothing (empty_cubes_shared.h). `size`: voxels an edge; reads the widest of `cascades`.
[[nodiscard]] Result<void> add_empty_cubes(graph::Graph& graph, gpu::Pipelines& pipelines, const VolumeImages& images,
                                           std::uint32_t size, std::uint32_t cascades, const bool& outdated);

}  // namespace heliodon::passes
