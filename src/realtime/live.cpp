#include "realtime/live.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "realtime/camera_frame.h"
#include "realtime/frame_renderer.h"

namespace heliodon {
namespace {

using realtime::FrameRenderer;
using realtime::FrameSample;

// A picture at rest is refined this long, then only shown.
constexpr int most_samples = 1024;
// The first samples share one filtered shadow map, so that motion costs one; then its grid moves.
constexpr int filtered_samples = 8;
constexpr int samples_per_shadow_grid = 4;
// An exposure has settled to a thousandth of its way after so many of its time constants.
constexpr float settled_time_constants = 7;
// How often a scene with blended surfaces is asked whether all of them found room (it waits for the GPU).
constexpr int frames_between_overflow_checks = 16;

/// Whether the scene's settings may have changed since the journal stood at `since`.
bool settings_changed(const Scene& scene, std::uint64_t since) {
    bool changed = false;
    const bool reaches_back = scene.changes_since(
        since, [&](const Change& change) { changed = changed || change.table == Change::Table::settings; });
    return changed || !reaches_back;
}

}  // namespace

struct LiveRenderer::State {
    std::unique_ptr<FrameRenderer> frames;
    shading::FrameData view{};  // of the accumulated picture, without jitter
    std::uint64_t revision = ~0ull;
    std::uint64_t journal = 0;  // of the scene, up to where its settings are known
    bool environment = true;
    int samples = 0;
    int frame_number = 0;
    float rested_s = 0;   // since anything last changed
    float exposure = 0;   // EV100 of the camera
};

LiveRenderer::LiveRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
LiveRenderer::~LiveRenderer() = default;
LiveRenderer::LiveRenderer(LiveRenderer&&) noexcept = default;
LiveRenderer& LiveRenderer::operator=(LiveRenderer&&) noexcept = default;

Result<LiveRenderer> LiveRenderer::create(gpu::Device& device, const std::string& shader_directory) try {
    auto state = std::make_unique<State>();
    auto frames = FrameRenderer::create(device, shader_directory);
    if (!frames) return tl::unexpected(frames.error());
    state->frames = std::move(*frames);
    return LiveRenderer(std::move(state));
} catch (const std::exception& exception) {
    return fail("", fmt::format("the live renderer could not start: {}", exception.what()));
}

Result<LiveRenderer::Frame> LiveRenderer::render(const Scene& scene, const Camera& camera, int width, int height,
                                                 bool environment, float seconds) try {
    State& state = *state_;
    FrameRenderer& frames = *state.frames;
    if (auto updated = frames.update(scene); !updated) return tl::unexpected(updated.error());
    if (auto done = frames.resize(width, height, true); !done) return tl::unexpected(done.error());
    shading::FrameData view = realtime::camera_frame(camera, frames.scene().bounds(), width, height, glm::vec2(0));
    view.exposure = 0;  // samples stay what they are however they are exposed
    const bool same = frames.scene().revision() == state.revision && environment == state.environment &&
                      !frames.shadows_lag() &&
                      !settings_changed(scene, state.journal) && std::memcmp(&view, &state.view, sizeof(view)) == 0;
    if (!same) state.samples = 0, state.rested_s = 0;
    state.rested_s += seconds;
    state.view = view;
    state.revision = frames.scene().revision();
    state.journal = scene.journal_end();
    state.environment = environment;

    const ExposureSettings& exposure = scene.render_settings().display.exposure;
    const bool exposed_anew = state.exposure != camera.ev100();
    state.exposure = camera.ev100();
    const bool adapting = exposure.mode != ExposureMode::camera &&
                          state.rested_s < settled_time_constants * std::max(exposure.to_light_s, exposure.to_dark_s);
    if (state.samples < most_samples || adapting || exposed_anew) {
        FrameSample sample;
        sample.index = static_cast<std::uint32_t>(state.samples);
        sample.count = 0;
        sample.jitter = realtime::sample_position(sample.index, 0, 0) - 0.5f;
        sample.jitter_shadows = state.samples >= filtered_samples;
        const int per_grid = frames.has_area_lights() || frames.refreshes_in_turns() ? 1 : samples_per_shadow_grid;
        sample.shadow_index = sample.jitter_shadows ? sample.index / per_grid : 0;
        sample.environment = environment;
        sample.cone_traced = frames.settings().gi == "vct";
        sample.occludes_sky = frames.settings().gi == "none";
        sample.replace = state.samples == 0;
        sample.display = {.sample_scale = 1.0f / static_cast<float>(state.samples + 1), .seconds = seconds};
        sample.texture_gradient_scale = 1.0f / std::sqrt(static_cast<float>(std::min(state.samples + 1, 64)));
        if (auto done = frames.render(camera, sample); !done) return tl::unexpected(done.error());
        ++state.samples;
        if (++state.frame_number % frames_between_overflow_checks == 0) {
            auto grown = frames.grow_fragments();
            if (!grown) return tl::unexpected(grown.error());
            auto voxels_grown = frames.grow_volume();
            if (!voxels_grown) return tl::unexpected(voxels_grown.error());
            if (*grown || *voxels_grown) state.samples = 0;
        }
    }
    Frame frame;
    frame.image = &frames.display();
    frame.accumulated_frames = state.samples;
    return frame;
} catch (const std::exception& exception) {
    return fail("", fmt::format("rendering live: {}", exception.what()));
}

std::vector<PassTime> LiveRenderer::pass_times() { return state_->frames->latest_times().passes; }

gpu::Pipelines& LiveRenderer::pipelines() { return state_->frames->pipelines(); }

Result<void> LiveRenderer::reload_shaders() try {
    auto reload = state_->frames->pipelines().reload();
    state_->samples = 0;
    if (!reload.errors.empty()) return tl::unexpected(reload.errors.front());
    return {};
} catch (const std::exception& exception) {
    return fail("", fmt::format("reloading shaders: {}", exception.what()));
}

}  // namespace heliodon
