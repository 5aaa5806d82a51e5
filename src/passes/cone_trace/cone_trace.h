#pragma once

#include "passes/cone_trace/volume_shared.h"
#include "passes/shade/shade.h"

namespace heliodon::passes {

struct ConeTraceOptions {
    bool aov = false;              ///< what FrameData::aov asks for instead of indirect light
    bool half_resolution = false;  ///< diffuse cones at one pixel in four, upsampled by depth and normal
};
/// Adds to `picture` the indirect light of what `visibility` shows.
[[nodiscard]] Result<void> add_cone_trace(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                          const LightingInputs& lighting, const VolumeInputs& volume,
                                          const VolumeImages& images, const Visibility& visibility,
                                          graph::ImageHandle picture, VkExtent2D extent,
                                          const ConeTraceOptions& options);

}  // namespace heliodon::passes
