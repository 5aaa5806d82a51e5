#pragma once

#include <string>
#include <vector>

#include "app/cli/bench_timing.h"
#include "core/result.h"

namespace heliodon::cli {

/// A frame's time as one kind of work grows and everything else stays: 128³ voxels or as many
/// as asked for, the size asked for, 45 thousand
/// triangles, one light; every effect of voxel cone tracing, voxelized in each frame.
struct CostSeries {
    std::string name;  ///< voxels, pixels, triangles, lights
    struct Row {
        double work = 0;  ///< so many of them
        FrameTime frame;
    };
    std::vector<Row> rows;
};
struct CostReport {
    std::string device;
    int voxels = 128;  ///< an edge, where they do not grow
    std::vector<CostSeries> series;
};
inline constexpr const char* cost_series[] = {"voxels", "pixels", "triangles", "lights"};

/// Measures the series of these names, with `voxels` an edge where they do not grow. Progress goes to standard error.
[[nodiscard]] Result<CostReport> run_cost(const TimingOptions& options, int voxels,
                                          const std::vector<std::string>& names);

[[nodiscard]] std::string as_text(const CostReport& report, const TimingOptions& options);
[[nodiscard]] std::string as_json(const CostReport& report, const TimingOptions& options);

}  // namespace heliodon::cli
