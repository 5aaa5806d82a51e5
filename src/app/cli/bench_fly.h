#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/bench_timing.h"
#include "app/cli/scene_argument.h"
#include "core/result.h"

namespace heliodon::cli {

/// How a frame is lit. Lamps of a scene are off in all of them.
struct FlyMode {
    const char* key;
    const char* column;  ///< over its passes
    const char* shows;
    /// Sun and sky by Hošek and Wilkie; else one directional light and an even sky without occlusion.
    bool sunlight = false;
    bool volumes = false;       ///< shadow volumes instead of shadow maps
    bool keep_shadows = false;  ///< drawn once: nothing moves
};
inline constexpr std::array<FlyMode, 4> fly_modes{{
    {"simple", "simple", "simple: directional light, constant ambient", false, false, true},
    {"sunlight", "sunlight", "sunlight: sun, sky, shadow maps kept", true, false, true},
    {"sunlight_redrawn", "redrawn", "sunlight, shadow maps redrawn", true, false, false},
    {"sunlight_volumes", "volumes", "sunlight with shadow volumes", true, true, true},
}};

/// Frames a second that were published of the FLY renderer, on its authors' hardware.
struct FlyPublished {
    int triangles = 0;
    double simple_fps = 0, light_maps_fps = 0, sunlight_fps = 0;
};
inline constexpr std::array<FlyPublished, 3> published_fly{
    {{138000, 33, 35, 12}, {107000, 33, 38, 14}, {313000, 24, 26, 7}}};

struct FlyModel {
    std::string name;
    std::size_t triangles = 0;
    std::optional<FlyPublished> published;  ///< the row of the table that the model stands for
    std::vector<FrameTime> frames;          ///< by the modes asked for
};

struct FlyOptions {
    std::vector<SceneArgument> scenes;  ///< none: the built-in models
    TimingOptions timing;
    std::vector<FlyMode> modes{fly_modes.begin(), fly_modes.end()};
};

struct FlyReport {
    std::string device;
    std::vector<FlyModel> models;
};

/// Times every model in every mode. Progress goes to standard error.
[[nodiscard]] Result<FlyReport> run_fly(const FlyOptions& options);

[[nodiscard]] std::string as_text(const FlyReport& report, const FlyOptions& options);
[[nodiscard]] std::string as_json(const FlyReport& report, const FlyOptions& options);

}  // namespace heliodon::cli
