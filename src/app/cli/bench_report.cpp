// What `heliodon bench natus` prints: the published tables as text, or everything as JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "app/cli/bench_natus.h"

namespace heliodon::cli {
namespace {

using nlohmann::ordered_json;

constexpr int published_voxels = 128;
constexpr double published_path_seconds = 18 * 60, published_frame_ms = 20;  // "18 minutes against 20 ms"

constexpr std::pair<const char*, double FrameSteps::*> step_names[] = {{"shadow map", &FrameSteps::shadow_map_ms},
                                                                       {"voxelize", &FrameSteps::voxelize_ms},
                                                                       {"filter", &FrameSteps::filter_ms},
                                                                       {"cone trace", &FrameSteps::cone_trace_ms},
                                                                       {"rest", &FrameSteps::rest_ms}};

const NatusTiming* find(const NatusReport& report, int test, int voxels, bool each_frame) {
    for (const NatusTiming& timing : report.timings)
        if (timing.test.number == test && timing.voxels == voxels && timing.each_frame == each_frame) return &timing;
    return nullptr;
}

std::string cell(const NatusTiming* timing) {
    return timing ? fmt::format("{:.2f} ({:.2f})", timing->frame.mean_ms, timing->frame.median_ms) : "";
}

std::string grid(int voxels) {
    return fmt::format("{}³", voxels);
}

std::string frame_table(const NatusReport& report, const std::vector<int>& grids) {
    std::string text =
        fmt::format("{:<36}{:<{}}{:<{}}\n", "voxelized", "in each frame", 18 * grids.size(), "once", 18 * grids.size());
    text += fmt::format("{:<36}", "test");
    for (int half = 0; half < 2; ++half)
        for (const int voxels : grids) text += fmt::format("{:<18}", grid(voxels));
    text += "GTX 960, 128³\n";
    for (const NatusTest& test : natus_tests) {
        std::string row = fmt::format("{:<36}", fmt::format("{} {}", test.number, test.shows));
        bool measured = false;
        for (const bool each_frame : {true, false})
            for (std::size_t i = 0; i < grids.size(); ++i) {
                const bool no_volume = !test.gi && each_frame && i == 0;
                const NatusTiming* timing = find(report, test.number, no_volume ? 0 : grids[i], each_frame && test.gi);
                measured = measured || timing;
                row += fmt::format("{:<18}", cell(timing));
            }
        if (measured) text += row + (test.published_ms ? fmt::format("{:.2f}", *test.published_ms) : "-") + "\n";
    }
    return text;
}

std::string step_table(const NatusReport& report, const std::vector<int>& grids) {
    const int test = find(report, 4, grids.front(), true) ? 4 : 5;
    if (!find(report, test, grids.front(), true)) return "";
    std::string text = fmt::format("{:<36}", fmt::format("steps of test {}, voxelized each frame", test));
    for (const int voxels : grids) text += fmt::format("{:>12}", grid(voxels));
    text += "   GTX 960, 128³\n";
    for (const auto& [name, step] : step_names) {
        text += fmt::format("{:<36}", name);
        for (const int voxels : grids)
            if (const NatusTiming* timing = find(report, test, voxels, true))
                text += fmt::format("{:>12.3f}", timing->frame.steps.*step);
        const double published = published_natus_steps.*step;
        text += published > 0 ? fmt::format("{:>16.2f}\n", published) : fmt::format("{:>16}\n", "-");
    }
    return text;
}

std::string error_text(const NoiselessError& error) {
    return fmt::format("relMSE {:.4g} ± {:.2g}", error.relmse, error.half_width_95);
}

std::string equal_error_text(const EqualError& e) {
    std::string text = fmt::format(
        "test 4, one frame with {} voxels: {} (95 %), against two path-traced references ({} samples a pixel each, "
        "{:.1f} s)\n",
        grid(e.voxels), error_text(e.frame), e.reference_samples, e.reference_seconds);
    for (const EqualError::Measured& path : e.path)
        text += fmt::format("path tracer, {} threads: {} samples a pixel in {:.2f} s: {}\n", e.threads, path.samples,
                            path.seconds, error_text(path.error));
    if (!e.path_seconds)
        return text + "an error is smaller than it is certain: trace the references for longer (--path-seconds)\n";
    return text +
           fmt::format(
               "path tracer to equal error: {:.4g} samples a pixel, {:.4g} s (1/N from both, by inverse variances)\n"
               "against {:.3f} ms in real time: {:.4g} times as long (published: 18 minutes against 20 "
               "ms, {:.0f} times)\n",
               *e.path_samples, *e.path_seconds, e.frame_ms, *e.ratio(),
               published_path_seconds * 1000 / published_frame_ms);
}

ordered_json optional_json(const std::optional<double>& value) {
    return value ? ordered_json(*value) : ordered_json();
}

ordered_json timing_json(const NatusTiming& timing) {
    ordered_json entry = {{"test", timing.test.number}, {"shows", timing.test.shows}};
    entry["voxels"] = timing.voxels > 0 ? ordered_json(timing.voxels) : ordered_json();
    entry["revoxelize"] = !timing.test.gi ? ordered_json() : ordered_json(timing.each_frame ? "always" : "once");
    entry["frame_mean_ms"] = timing.frame.mean_ms;
    entry["frame_median_ms"] = timing.frame.median_ms;
    entry["steps"] = steps_json(timing.frame.steps);
    const bool published = !timing.test.gi || (timing.voxels == published_voxels && timing.each_frame);
    entry["published_gtx_960_ms"] = published ? optional_json(timing.test.published_ms) : ordered_json();
    return entry;
}

ordered_json equal_error_json(const EqualError& e) {
    ordered_json measured = ordered_json::array();
    for (const EqualError::Measured& path : e.path)
        measured.push_back({{"spp", path.samples},
                            {"seconds", path.seconds},
                            {"relmse", path.error.relmse},
                            {"relmse_half_width_95", path.error.half_width_95}});
    return {
        {"test", 4},
        {"voxels", e.voxels},
        {"frame_mean_ms", e.frame_ms},
        {"frame_relmse", e.frame.relmse},
        {"frame_relmse_half_width_95", e.frame.half_width_95},
        {"reference_spp", e.reference_samples},
        {"reference_seconds", e.reference_seconds},
        {"path_threads", e.threads},
        {"path_measured", std::move(measured)},
        {"path_method", "relmse = a/N, a by both measured pictures (inverse variances), solved for the frame's relmse"},
        {"path_spp", optional_json(e.path_samples)},
        {"path_seconds", optional_json(e.path_seconds)},
        {"path_over_frame", optional_json(e.ratio())},
        {"published_path_over_frame", published_path_seconds * 1000 / published_frame_ms}};
}

}  // namespace

std::string as_text(const NatusReport& report, const NatusOptions& options) {
    std::string text = fmt::format(
        "natus: {} ({} triangles), {}, {}x{}\nmilliseconds a frame on the GPU, mean (median) of {} frames\n\n",
        report.scene, report.triangles, report.device, options.timing.size.width, options.timing.size.height,
        options.timing.frames);
    text += frame_table(report, options.voxels);
    text += '\n';
    text += step_table(report, options.voxels);
    if (!report.equal_error) return text;
    text += '\n';
    text += equal_error_text(*report.equal_error);
    return text;
}

std::string as_json(const NatusReport& report, const NatusOptions& options) {
    ordered_json timings = ordered_json::array();
    for (const NatusTiming& timing : report.timings) timings.push_back(timing_json(timing));
    ordered_json published = steps_json(published_natus_steps);
    published["rest_ms"] = nullptr;
    const ordered_json all = {
        {"benchmark", "natus"},
        {"scene", report.scene},
        {"triangles", report.triangles},
        {"device", report.device},
        {"width", options.timing.size.width},
        {"height", options.timing.size.height},
        {"frames_timed", options.timing.frames},
        {"timings", std::move(timings)},
        {"published_steps_gtx_960", std::move(published)},
        {"equal_error", report.equal_error ? equal_error_json(*report.equal_error) : ordered_json()}};
    return all.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace heliodon::cli
