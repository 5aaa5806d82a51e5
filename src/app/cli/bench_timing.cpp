#include "app/cli/bench_timing.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "app/cli/scene_argument.h"
#include "app/cli/terminal.h"

namespace heliodon::cli {
namespace {

/// The passes of each step, by how their names begin.
constexpr std::pair<std::string_view, double FrameSteps::*> step_of_passes[] = {
    {"shadow", &FrameSteps::shadow_map_ms},    {"voxelize", &FrameSteps::voxelize_ms},
    {"inject", &FrameSteps::filter_ms},        {"gather", &FrameSteps::filter_ms},
    {"radiance", &FrameSteps::filter_ms},      {"filter", &FrameSteps::filter_ms},
    {"occupancy", &FrameSteps::filter_ms},     {"cone trace", &FrameSteps::cone_trace_ms},
    {"trace", &FrameSteps::cone_trace_ms},     {"weigh pixels", &FrameSteps::cone_trace_ms},
    {"clear pixel lists", &FrameSteps::cone_trace_ms}};

}  // namespace

FrameSteps steps_of(const std::vector<PassTime>& passes) {
    FrameSteps steps;
    for (const PassTime& pass : passes) {
        const auto found = std::find_if(std::begin(step_of_passes), std::end(step_of_passes),
                                        [&](const auto& step) { return pass.name.starts_with(step.first); });
        steps.*(found == std::end(step_of_passes) ? &FrameSteps::rest_ms : found->second) += pass.gpu_ms;
    }
    return steps;
}

nlohmann::ordered_json steps_json(const FrameSteps& steps) {
    return {{"shadow_map_ms", steps.shadow_map_ms},
            {"voxelize_ms", steps.voxelize_ms},
            {"filter_ms", steps.filter_ms},
            {"cone_trace_ms", steps.cone_trace_ms},
            {"rest_ms", steps.rest_ms}};
}

FrameTimer::FrameTimer(const Scene& scene, const Camera& camera, int frames, RealtimeRenderer renderer)
    : scene_(&scene), camera_(camera), renderer_(std::move(renderer)), frames_(frames) {}

Result<FrameTimer> FrameTimer::create(const Scene& scene, const std::string& name, const TimingOptions& options) {
    const auto camera = choose_camera(scene, {name, {}}, "");
    if (!camera) return tl::unexpected(camera.error());
    auto renderer = RealtimeRenderer::create(options.device);
    if (!renderer) return tl::unexpected(renderer.error());
    return FrameTimer(scene, *camera, options.frames, std::move(*renderer));
}

Result<FrameTime> FrameTimer::time(Size size, Picture* picture, bool keep_shadows) {
    RealtimeOptions options;
    options.width = size.width;
    options.height = size.height;
    options.samples = picture ? 1 : 0;
    options.gi = scene_->render_settings().gi;
    options.frames_timed = frames_;
    options.keep_shadows = keep_shadows;
    RealtimeStatistics numbers;
    auto rendered = renderer_.render(*scene_, camera_, options, &numbers);
    if (interrupted()) return fail("", "interrupted");
    if (!rendered) return tl::unexpected(rendered.error());
    if (picture) *picture = std::move(*rendered);
    device_ = numbers.device;
    const FrameSteps steps = steps_of(numbers.passes);
    return FrameTime{numbers.gpu_ms_mean, numbers.gpu_ms_total, steps, std::move(numbers.passes),
                     numbers.shadow_maps_drawn};
}

}  // namespace heliodon::cli
