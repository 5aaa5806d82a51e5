#pragma once

#include "passes/cone_trace/volume_shared.h"
#include "passes/shade/shade.h"

namespace heliodon::passes {

struct ConeTraceOptions {
    bool aov = false;           ///< what FrameData::aov asks for instead of indirect light
    std::uint32_t spacing = 1;  ///< of the pixels that trace cones for those about them: 1, 2 or 4
};
/// Which pixels are like the traced ones about them, and lists of the others.
struct ConeWeights {
    graph::ImageHandle weights;
    graph::BufferHandle listed;
};
[[nodiscard]] Result<ConeWeights> add_cone_weights(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                                   const LightingInputs& lighting, const Surfaces& surfaces, VkExtent2D extent,
                                                   const ConeTraceOptions& options);
/// What cones are traced for and through.
struct ConeTrace {
    const SceneInputs& scene;
    const LightingInputs& lighting;
    const VolumeInputs& volume;
    VolumeImages images;
    Surfaces surfaces;
    ConeWeights weights;
    VkExtent2D extent;
    ConeTraceOptions options;
};
/// Their light: of traced pixels, and of listed ones.
struct TracedCones {
    graph::ImageHandle diffuse, specular;
    graph::ImageHandle own_diffuse, own_specular, transmitted;
};
[[nodiscard]] Result<TracedCones> add_cones(graph::Graph& graph, gpu::Pipelines& pipelines, const ConeTrace& cones);
/// Adds it to the picture.
[[nodiscard]] Result<void> add_cone_light(graph::Graph& graph, gpu::Pipelines& pipelines, const ConeTrace& cones, const TracedCones& traced,
                                          graph::ImageHandle picture);

}  // namespace heliodon::passes
