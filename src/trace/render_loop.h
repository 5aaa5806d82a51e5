#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "trace/cpu_kernel.h"
#include "trace/embree_scene.h"
#include "trace/path_tracer.h"
#include "trace/sample_sums.h"

namespace heliodon::trace {

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

/// Whether the samples of a pixel must say how far they scatter: then they take turns in independent sequences.
[[nodiscard]] bool wants_variance(const PathOptions& options);

struct Accumulation;
/// Adds to the picture what is new of the first `end` samples of every pixel.
using AddSamples = std::function<PathCounts(Accumulation& picture, int end)>;

/// The picture with its AOVs, and the state to go on from where the options want it. `floor_nits`: a target error is
/// relative to √(L² + floor²). `other`: instead of unidirectional paths one by one; a
/// target error needs one that follows `adaptive`.
[[nodiscard]] Result<Picture> render_picture(const CpuKernel& kernel, const EmbreeScene& scene,
                                             const PathOptions& options, double floor_nits, PathStatistics& statistics,
                                             const Progress& progress, const AddSamples& other = {});

}  // namespace heliodon::trace
