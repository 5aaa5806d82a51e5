#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/bench_equal_error.h"
#include "app/cli/bench_timing.h"
#include "app/cli/scene_argument.h"
#include "core/result.h"

namespace heliodon::cli {

/// One of the five published pictures: its effects, and its frame on a GeForce GTX 960 with 128³ voxels at 1024×768.
struct NatusTest {
    int number = 0;
    const char* shows = "";
    bool emissive = false;  ///< of the scene that only its wall lights
    bool gi = true, shadows_by_cones = false, occlusion = false;
    float bulb_radius_m = 0;
    std::optional<double> published_ms;
};
inline constexpr std::array<NatusTest, 5> natus_tests{{
    {1, "direct light", false, false, false, false, 0, 4.09},
    {2, "GI with reflection and refraction", false, true, false, false, 0, 18.23},
    {3, "2 + soft shadows by cones", false, true, true, false, 0.05f, 22.36},
    {4, "3 + ambient occlusion", false, true, true, true, 0.05f, 22.34},
    {5, "emissive wall only", true, true, true, true, 0, std::nullopt},
}};

/// The steps of a frame on a GeForce GTX 960; the rest was not published.
inline constexpr FrameSteps published_natus_steps{0.30, 1.96, 0.23, 22.83, 0};

struct NatusTiming {
    NatusTest test;
    int voxels = 0;           ///< an edge; 0 where there is no volume
    bool each_frame = false;  ///< surfaces were voxelized in every frame
    FrameTime frame;
};

struct NatusOptions {
    SceneArgument scene;  ///< no path: the built-in scene
    TimingOptions timing;
    std::vector<int> voxels{256, 128, 64};
    std::vector<int> tests{1, 2, 3, 4, 5};
    double path_seconds = 60;  ///< in all; 0: no comparison with the path tracer
};

struct NatusReport {
    std::string scene, device;
    std::size_t triangles = 0;
    std::vector<NatusTiming> timings;
    std::optional<EqualError> equal_error;
};

/// Measures every test of the scene (those that its lights allow) with every grid. Progress goes to standard error.
[[nodiscard]] Result<NatusReport> run_natus(const NatusOptions& options);

[[nodiscard]] std::string as_text(const NatusReport& report, const NatusOptions& options);
[[nodiscard]] std::string as_json(const NatusReport& report, const NatusOptions& options);

}  // namespace heliodon::cli
