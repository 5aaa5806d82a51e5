#pragma once

#include "passes/shade/shade.h"

namespace heliodon::passes {

/// Bytes of a fragment buffer for `capacity` fragments; its second word keeps the most that any sample wanted.
[[nodiscard]] VkDeviceSize blend_buffer_bytes(std::uint32_t capacity);

/// Alpha-blended surfaces over `picture`: a list of fragments a pixel, shaded from back to front. Fragments
/// that find no room in `fragments` are counted there, not drawn. `cone_traced`: with indirect light from the volume.
[[nodiscard]] Result<void> add_blend(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene,
                                     const LightingInputs& lighting, const gpu::Buffer& views, const DrawLists& lists,
                                     const Visibility& visibility, const ShadowMaps& shadow_maps, const VolumeImages& volume,
                                     graph::BufferHandle fragments, graph::ImageHandle picture, VkExtent2D extent,
                                     bool cone_traced);

}  // namespace heliodon::passes
