#pragma once

#include "graph/executor.h"
#include "gpu/pipeline.h"
#include "passes/meter/meter_shared.h"

namespace heliodon::passes {

/// What a frame's exposure follows from; read when the passes record.
struct ExposureInputs {
    float sample_scale = 1;  ///< 1 / samples in the sum
    shading::ExposeConstants expose{};
};

/// Exposes the picture that `sum` · sample_scale is: by a light meter on it where `metered` (whatever `inputs` says about
/// exposure and white needs the picture), by the camera otherwise. Returns the buffer of the ExposureState, which the CPU
/// never waits for.
[[nodiscard]] Result<graph::BufferHandle> add_meter(graph::Graph& graph, gpu::Pipelines& pipelines, graph::ImageHandle sum,
                                                    const ExposureInputs& inputs, bool metered, VkExtent2D extent);

}  // namespace heliodon::passes
