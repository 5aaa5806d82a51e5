#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/cli/option_values.h"
#include "core/result.h"
#include "realtime/renderer.h"

namespace heliodon::cli {

/// GPU milliseconds of a frame by step: medians.
struct FrameSteps {
    double shadow_map_ms = 0, voxelize_ms = 0, filter_ms = 0, cone_trace_ms = 0, rest_ms = 0;
};
/// The passes, each of which belongs to one step.
[[nodiscard]] FrameSteps steps_of(const std::vector<PassTime>& passes);

[[nodiscard]] nlohmann::ordered_json steps_json(const FrameSteps& steps);

/// GPU milliseconds of a frame.
struct FrameTime {
    double mean_ms = 0, median_ms = 0;
    FrameSteps steps;
    std::vector<PassTime> passes;  ///< in the order of the frame
    std::uint64_t shadow_maps_drawn = 0;  ///< in all frames that were timed
};

struct TimingOptions {
    Size size;
    int frames = 50;  ///< timed of each, after warm-up
    RealtimeSettings device;
};

/// Times frames of one scene, whose settings may change in between, through its first camera.
class FrameTimer {
public:
    /// `scene` must outlive this; `name` is what errors call it.
    [[nodiscard]] static Result<FrameTimer> create(const Scene& scene, const std::string& name,
                                                   const TimingOptions& options);
    /// By the scene's settings. Leaves one frame's picture in `picture`, where wanted. `keep_shadows`: shadow maps are
    /// drawn in the first frame alone, as in the live viewer while nothing moves.
    [[nodiscard]] Result<FrameTime> time(Size size, Picture* picture = nullptr, bool keep_shadows = false);

    [[nodiscard]] const Camera& camera() const { return camera_; }
    [[nodiscard]] const std::string& device() const { return device_; }  ///< once something was timed

private:
    FrameTimer(const Scene& scene, const Camera& camera, int frames, RealtimeRenderer renderer);

    const Scene* scene_;
    Camera camera_;
    RealtimeRenderer renderer_;
    int frames_;
    std::string device_;
};

}  // namespace heliodon::cli
