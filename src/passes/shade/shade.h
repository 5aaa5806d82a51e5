#pragma once

#include "passes/common/scene_inputs.h"
#include "passes/common/volume_inputs.h"
#include "passes/shadow/shadow.h"
#include "passes/visibility/visibility.h"

namespace heliodon::passes {

/// What lighting needs besides the scene's tables; the owner keeps it at one address.
struct LightingInputs {
    const gpu::Buffer* frame = nullptr;           ///< FrameData
    const gpu::Buffer* shadow_views = nullptr;    ///< ShadowViewData
    const gpu::Buffer* shading_tables = nullptr;  ///< shading/tables.h
    VkSampler nearest = VK_NULL_HANDLE;
    const gpu::Buffer* visible_lights = nullptr;  ///< visible_lights.glsl: lights with an extent
    const VolumeInputs* volume = nullptr;         ///< lights with a cone_radius cast their shadows through it
    bool cone_shadows = false;                    ///< some light has one; pipelines are chosen by it
    bool shadows_traced = false;                  ///< ahead, for pixels and voxels: few enough lights (passes/shadow_cones)
    const gpu::Buffer* light_grid = nullptr;      ///< light_grid.h: for picking among very many lights
};

struct Shaded {
    graph::ImageHandle picture;                 ///< RGBA32F radiance in cd/m², alpha = coverage
    graph::ImageHandle places, albedos, lobes;  ///< of its surfaces (cone_trace/cone_surface.glsl), where cones follow
    graph::ImageHandle ids;                     ///< of the visibility buffer
};
struct ShadeOptions {
    bool aov = false;           ///< what FrameData::aov asks for instead of radiance
    bool cones_follow = false;  ///< surfaces are left for add_cone_trace()
    std::uint32_t shadow_spacing = 1;  ///< pixels between those that trace shadow cones for their neighbours
};
/// Lights the visibility buffer in compute: the batch's lights with their shadows, emission, sky.
[[nodiscard]] Result<Shaded> add_shade(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                       const LightingInputs& lighting, const Visibility& visibility,
                                       const ShadowMaps& shadow_maps, const VolumeImages& volume, VkExtent2D extent,
                                       const ShadeOptions& options);

}  // namespace heliodon::passes
