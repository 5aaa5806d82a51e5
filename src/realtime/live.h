#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "realtime/renderer.h"
#include "scene/scene.h"

namespace heliodon {

/// The real-time engine for a window: every call renders one frame of a scene that may have changed. While
/// nothing changes the frames accumulate to the still picture; any change starts anew.
class LiveRenderer {
public:
    /// `device` must outlive this. `shader_directory`: see RealtimeSettings.
    [[nodiscard]] static Result<LiveRenderer> create(gpu::Device& device, const std::string& shader_directory = {});
    ~LiveRenderer();
    LiveRenderer(LiveRenderer&&) noexcept;
    LiveRenderer& operator=(LiveRenderer&&) noexcept;

    struct Frame {
        /// RGBA8, display-encoded; its state() says its layout. Valid until the next render().
        const gpu::Image* image = nullptr;
        int accumulated_frames = 0;  ///< since anything last changed
    };
    /// Submits the frame's work; the caller's next submission sees the finished picture. Does not wait for it. `seconds`
    /// since the frame before: how far a metered exposure adapts.
    [[nodiscard]] Result<Frame> render(const Scene& scene, const Camera& camera, int width, int height, bool environment = true,
                                       float seconds = 1 / 60.0f);
    /// GPU milliseconds a pass of a frame a little earlier; never waits.
    [[nodiscard]] std::vector<PassTime> pass_times();
    /// For drawing over the picture with shaders of one's own.
    [[nodiscard]] gpu::Pipelines& pipelines();
    /// Compiles changed shaders again; the first error, if any (the old code then stays in use).
    [[nodiscard]] Result<void> reload_shaders();

private:
    struct State;
    explicit LiveRenderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace heliodon
