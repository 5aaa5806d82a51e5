#pragma once

#include "graph/executor.h"
#include "gpu/pipeline.h"

namespace heliodon::passes {

/// `sum` · `scale` (exposure / samples) through Hable's curve and sRGB into `display` (RGBA8).
[[nodiscard]] Result<void> add_tonemap(graph::Graph& graph, gpu::Pipelines& pipelines, graph::ImageHandle sum,
                                       graph::ImageHandle display, const float& scale, VkExtent2D extent);

}  // namespace heliodon::passes
