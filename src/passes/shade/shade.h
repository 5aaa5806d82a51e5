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

/// What cones need to know of the surfaces that a picture shows (cone_trace/cone_surface.glsl).
struct Surfaces {
    graph::ImageHandle places, albedos, lobes;
    graph::ImageHandle ids;  ///< of the visibility buffer
};
/// Images for them.
[[nodiscard]] Surfaces create_surfaces(graph::Graph& graph, const Visibility& visibility, VkExtent2D extent);
/// Leaves them ahead of light, where add_shade() shall not.
[[nodiscard]] Result<void> add_surfaces(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                        const LightingInputs& lighting, const Surfaces& surfaces, VkExtent2D extent);

struct ShadeOptions {
    bool aov = false;  ///< what FrameData::aov asks for instead of radiance
    const Surfaces* leaves = nullptr;  ///< what cones need to know of the surfaces, if it is to be left
    bool sky_follows = false;  ///< add_ambient_occlusion() adds the sky's light
    graph::ImageHandle traced_shadows{};   ///< of add_pixel_shadows(), if they are traced ahead …
    std::uint32_t shadow_spacing = 1;      ///< … by one pixel in so many squared
    graph::ImageHandle shadowed{};         ///< of add_shadow_volumes(), if FrameData::volume_light casts them …
    bool maps_follow = false;              ///< … and what casts none is in its shadow map
};
/// RGBA32F radiance in cd/m², alpha = coverage.
[[nodiscard]] graph::ImageHandle create_picture(graph::Graph& graph, VkExtent2D extent);
/// Lights the visibility buffer (its `ids`) in compute: the batch's lights with their shadows, emission, sky.
[[nodiscard]] Result<void> add_shade(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                     const LightingInputs& lighting, graph::ImageHandle ids, const ShadowMaps& shadow_maps,
                                     const VolumeImages& volume, graph::ImageHandle picture, VkExtent2D extent,
                                     const ShadeOptions& options);

}  // namespace heliodon::passes
