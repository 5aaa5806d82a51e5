#pragma once

#include <string>
#include <vector>

#include "app/cli/bench_timing.h"
#include "app/cli/scene_argument.h"
#include "core/result.h"

namespace heliodon::cli {

/// Shadow volumes of the sun behind the triangles that it lights, against those behind all that face it.
struct ShadowVolumeReport {
    struct Row {
        const char* behind = "";
        ShadowVolumeStatistics volumes;
        double depth_ms = 0, stencil_ms = 0;  ///< of a frame, medians: of its passes for volumes
        int different_pixels = 0;             ///< of one frame's picture, from the first row's
    };
    std::string scene, device;
    std::vector<Row> rows;
};

struct ShadowVolumeOptions {
    SceneArgument scene;
    TimingOptions timing;
};

/// Measures by direct light, through the scene's first camera.
[[nodiscard]] Result<ShadowVolumeReport> run_shadow_volumes(const ShadowVolumeOptions& options);

[[nodiscard]] std::string as_text(const ShadowVolumeReport& report, const ShadowVolumeOptions& options);
[[nodiscard]] std::string as_json(const ShadowVolumeReport& report, const ShadowVolumeOptions& options);

}  // namespace heliodon::cli
