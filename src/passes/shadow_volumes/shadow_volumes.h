#pragma once

#include "passes/cull/cull.h"
#include "passes/shadow_volumes/shadow_volumes_shared.h"

namespace heliodon::passes {

/// Volumes behind the triangles that one directional light meets first; the owner keeps this at one address.
struct ShadowVolumeInputs {
    const gpu::Buffer* sides = nullptr;  ///< side.vert
    const gpu::Buffer* caps = nullptr;   ///< cap.vert: those turned to the light, then those turned away
    const gpu::Buffer* draws = nullptr;  ///< VolumeDraw
    std::uint32_t cap_capacity = 0;      ///< of each kind
    glm::vec3 sun{0, -1, 0};             ///< unit, the way the light travels
    glm::mat4 world_to_clip{1};          ///< of the picture's sample, without far plane
};

/// Which pixels' surfaces stand in a volume: R8UI, 0 where the light reaches them. Volumes are counted in the stencil
/// beyond each surface (z-fail: Everitt & Kilgard 2002, "Practical and Robust Stenciled Shadow Volumes"), so the camera
/// may stand in one. Vulkan's stencil has eight bits: a surface in a multiple of 256 volumes is lit. `lists`: what the
/// camera sees. Blended surfaces are not asked about.
[[nodiscard]] Result<graph::ImageHandle> add_shadow_volumes(graph::Graph& graph, gpu::Pipelines& pipelines,
                                                            SceneInputs& scene, const ShadowVolumeInputs& inputs,
                                                            const DrawLists& lists, VkExtent2D extent);

}  // namespace heliodon::passes
