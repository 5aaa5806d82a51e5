#pragma once

#include "passes/cone_trace/volume_shared.h"
#include "passes/shade/shade.h"

namespace heliodon::passes {

struct ConeTraceOptions {
    bool aov = false;           ///< what FrameData::aov asks for instead of indirect light
    std::uint32_t spacing = 1;  ///< of the pixels that trace cones for those about them: 1, 2 or 4
};
/// Adds to the picture the indirect light of the surfaces that shading left.
[[nodiscard]] Result<void> add_cone_trace(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                          const LightingInputs& lighting, const VolumeInputs& volume,
                                          const VolumeImages& images, const Shaded& shaded, VkExtent2D extent,
                                          const ConeTraceOptions& options);

}  // namespace heliodon::passes
