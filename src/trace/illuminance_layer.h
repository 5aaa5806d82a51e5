#pragma once

#include "trace/render_loop.h"

namespace heliodon::trace {

/// Lux on the side that is seen of the first surface (blended ones are looked through), as a sensor there measures them:
/// the mean over those of `samples` that meet one. 0 on the back of a one-sided surface.
[[nodiscard]] Image illuminance_layer(const CpuKernel& kernel, const EmbreeScene& scene, const PathOptions& options, int samples);

}  // namespace heliodon::trace
