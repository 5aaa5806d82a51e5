#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "trace/cpu_kernel.h"
#include "trace/embree_scene.h"
#include "trace/path_tracer.h"

namespace heliodon::trace {

struct PathResult {
    glm::dvec3 radiance{0};
    glm::dvec3 direct{0};
};

/// Rays and mishaps of one thread's share of the work.
struct PathCounts {
    std::uint64_t rays = 0;
    std::uint64_t non_finite = 0;
};

/// Follows one path to its end. Light that is no finite number is counted and left out.
[[nodiscard]] PathResult follow_path(CpuKernel& kernel, const EmbreeScene& scene, shading::PathState& path,
                                     PathCounts& counts);

/// Runs `work` on `threads` threads, or on all cores where that is 0.
void run_on_threads(int threads, const std::function<void()>& work);

[[nodiscard]] Result<void> check_aovs(const std::vector<std::string>& names);

/// The picture with its AOVs. Each pixel sums its own samples in order, so that the result depends on
/// neither the tiles nor the threads.
[[nodiscard]] Picture render_picture(const CpuKernel& kernel, const EmbreeScene& scene, const PathOptions& options,
                                     PathStatistics& statistics, const Progress& progress);

}  // namespace heliodon::trace
