#pragma once

#include "graph/executor.h"
#include "gpu/pipeline.h"
#include "passes/tonemap/tonemap_shared.h"

namespace heliodon::passes {

/// `sum` · `constants.sample_scale` as it is exposed (an ExposureState), through the tone curve and sRGB into `display`
/// (RGBA8). `constants` are read when the pass records; their width and height are `extent`'s.
[[nodiscard]] Result<void> add_tonemap(graph::Graph& graph, gpu::Pipelines& pipelines, graph::ImageHandle sum,
                                       graph::BufferHandle exposure, graph::ImageHandle display,
                                       const shading::TonemapConstants& constants, VkExtent2D extent);

}  // namespace heliodon::passes
