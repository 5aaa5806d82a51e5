#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "realtime/renderer.h"
#include "scene/scene.h"

namespace heliodon {

/// What one live frame left.
struct LiveFrame {
    const gpu::Image* image = nullptr;  ///< RGBA8, exposed, tone-mapped, sRGB-encoded; its tracked state is true
    int accumulated_frames = 0;         ///< jittered frames averaged since anything last changed
};

/// The real-time engine for a window: one frame a call of a scene that may change between calls, recorded
/// into the caller's commands on the caller's device. A picture that stays still goes on converging.
class LiveRenderer {
public:
    /// `device` must outlive this. `shader_directory`: as RealtimeSettings'.
    [[nodiscard]] static Result<LiveRenderer> create(gpu::Device& device, const std::string& shader_directory = {});
    ~LiveRenderer();
    LiveRenderer(LiveRenderer&&) noexcept;
    LiveRenderer& operator=(LiveRenderer&&) noexcept;

    /// Follows the scene's journal and records one frame of `width` × `height`.
    [[nodiscard]] Result<LiveFrame> render(gpu::Commands& commands, const Scene& scene, const Camera& camera, int width, int height);
    /// Milliseconds a pass of the latest frame that is complete, without waiting for any.
    [[nodiscard]] std::vector<PassTime> pass_times();
    [[nodiscard]] gpu::Pipelines& pipelines();

private:
    struct State;
    explicit LiveRenderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace heliodon
