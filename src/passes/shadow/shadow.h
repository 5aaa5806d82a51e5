#pragma once

#include "passes/cull/cull.h"

namespace heliodon::passes {

inline constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;

/// What of the shadow maps the frame being recorded renders.
struct ShadowInputs {
    const gpu::Buffer* views = nullptr;  ///< ViewData a layer
    std::uint32_t view_count = 0;
    std::uint32_t random_seed = 0;  ///< of the share of light that blended surfaces let through
};

/// Depth maps of the lights, one layer of `maps` a view, reversed depth. Both sides of every surface block
/// light, so that open, inside-out and non-manifold meshes cast the shadow they should.
[[nodiscard]] Result<void> add_shadow(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene,
                                      const ShadowInputs& inputs, const DrawLists& lists, graph::ImageHandle maps);

}  // namespace heliodon::passes
