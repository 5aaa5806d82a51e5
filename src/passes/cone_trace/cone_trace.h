#pragma once

#include "passes/cone_trace/volume_shared.h"
#include "passes/shade/shade.h"

namespace heliodon::passes {

/// Adds to `picture` the indirect light of what `visibility` shows; with `aov` what FrameData::aov asks for.
[[nodiscard]] Result<void> add_cone_trace(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                          const LightingInputs& lighting, const VolumeInputs& volume,
                                          graph::ImageHandle volume_faces, const Visibility& visibility,
                                          graph::ImageHandle picture, VkExtent2D extent, bool aov);

}  // namespace heliodon::passes
