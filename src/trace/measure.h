#pragma once

#include "trace/render_loop.h"

namespace heliodon::trace {

/// Every sensor's reading: the mean of independent batches, and the 95 % half-width of that mean from
/// Student's distribution. Illuminances are sampled where a pilot found light to come from.
[[nodiscard]] std::vector<SensorReading> measure_sensors(const Scene& scene, const CpuKernel& kernel,
                                                         const EmbreeScene& embree, const PathOptions& options,
                                                         const Progress& progress);

}  // namespace heliodon::trace
