#pragma once

#include "passes/ambient_occlusion/ambient_occlusion_shared.h"
#include "passes/shade/shade.h"

namespace heliodon::passes {

/// Adds to the picture the light of the sky, and what surroundings reflect, on the surfaces that shading left, as far as
/// nothing that the picture shows hides it. `constants` are read when the frame is recorded. `aov`: what FrameData::aov asks
/// for instead: openness, or illuminance.
[[nodiscard]] Result<void> add_ambient_occlusion(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                                 const LightingInputs& lighting, const Surfaces& surfaces, graph::ImageHandle picture,
                                                 VkExtent2D extent, const shading::AmbientOcclusionConstants& constants, bool aov);

}  // namespace heliodon::passes
