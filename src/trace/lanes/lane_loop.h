#pragma once

#include "trace/cpu_kernel.h"
#include "trace/embree_scene.h"
#include "trace/render_loop.h"

namespace heliodon::trace {

/// Pictures by the same paths eight at a time, for render_picture; only where lanes_available(). They differ from those
/// followed one by one in rounding alone, and depend as little on threads and interruptions.
[[nodiscard]] AddSamples lane_samples(const CpuKernel& kernel, const EmbreeScene& scene);

}  // namespace heliodon::trace
