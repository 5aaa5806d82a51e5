#pragma once

#include "passes/cull/cull.h"

namespace heliodon::passes {

struct Visibility {
    graph::ImageHandle ids;    ///< RG32UI: instance + 1 (0: background), triangle
    graph::ImageHandle depth;  ///< reversed
};

/// Which triangle each pixel's sample sees: opaque and alpha-masked surfaces.
[[nodiscard]] Result<Visibility> add_visibility(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene,
                                                const gpu::Buffer& views, const DrawLists& lists, VkExtent2D extent);

}  // namespace heliodon::passes
