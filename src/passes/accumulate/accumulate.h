#pragma once

#include "graph/executor.h"
#include "gpu/pipeline.h"

namespace heliodon::passes {

/// Adds `picture` to `sum` (RGBA32F); `replace` true starts the sum anew.
[[nodiscard]] Result<void> add_accumulate(graph::Graph& graph, gpu::Pipelines& pipelines, graph::ImageHandle picture,
                                          graph::ImageHandle sum, const bool& replace, VkExtent2D extent);

}  // namespace heliodon::passes
