#pragma once

#include "passes/cull/cull.h"

namespace heliodon::passes {

inline constexpr VkFormat shadow_depth_format = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat shadow_slope_format = VK_FORMAT_R16G16_SFLOAT;

/// Image arrays; one or more views a layer.
struct ShadowMaps {
    graph::ImageHandle depth;  ///< reversed
    graph::ImageHandle slope;  ///< of the depth, a texel, relative to it: the plane of the triangle that stands there
};

struct ShadowDraw {
    std::uint32_t view = 0, layer = 0;
    VkRect2D area{};
};
/// What of the shadow maps the frame being recorded renders.
struct ShadowInputs {
    const gpu::Buffer* views = nullptr;  ///< ViewData
    std::vector<ShadowDraw> draws;       ///< what is drawn; other maps stay
    std::uint32_t view_count = 0;
    std::uint32_t random_seed = 0;  ///< of the share of light that blended surfaces let through
};

/// Maps of what the lights see. Both sides of every surface block
/// light, so that open, inside-out and non-manifold meshes cast the shadow they should.
[[nodiscard]] Result<void> add_shadow(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene,
                                      const ShadowInputs& inputs, const DrawLists& lists, const ShadowMaps& maps);

}  // namespace heliodon::passes
