#pragma once

#include <functional>

#include "passes/inject/inject.h"
#include "passes/shade/shade.h"

namespace heliodon::passes {

/// The most lights of a batch whose shadow cones are traced ahead (light_visibility.glsl).
inline constexpr std::uint32_t most_lights_traced = 4;

/// RGBA32UI, of one pixel in `spacing`² (`ids`: of the visibility buffer): its depth and geometric normal, and what of each light reaches it.
[[nodiscard]] Result<graph::ImageHandle> add_pixel_shadows(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                                           const LightingInputs& lighting, graph::ImageHandle ids,
                                                           const VolumeImages& volume, VkExtent2D extent, std::uint32_t spacing);
/// The cones of voxels, to be traced by a pass of their own or within another beside its work, while they wait for the volume.
struct VoxelShadows {
    graph::BufferHandle shares;  ///< eight bytes a record: what of each light reaches the voxel's surfaces
    std::function<void(graph::PassBuilder&)> uses;
    std::function<void(graph::PassContext&)> record;
};
[[nodiscard]] Result<VoxelShadows> voxel_shadows(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                                 const LightingInputs& lighting, const InjectCascade& cascade, const VolumeImages& images);

}  // namespace heliodon::passes
