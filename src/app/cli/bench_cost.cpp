#include "app/cli/bench_cost.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "app/cli/bench_scene.h"
#include "app/cli/terminal.h"

namespace heliodon::cli {
namespace {

using nlohmann::ordered_json;

/// One frame to time.
struct Load {
    int voxels = 0;
    Size size;
    int copies = 1;  // of 45 thousand triangles
    int lights = 1;
};

std::vector<Load> loads_of(const std::string& name, Size size, int edge) {
    std::vector<Load> loads;
    const auto add = [&](auto change) {
        Load load{.voxels = edge, .size = size};
        change(load);
        loads.push_back(load);
    };
    if (name == "voxels")
        for (const int voxels : {32, 64, 128, 256}) add([&](Load& load) { load.voxels = voxels; });
    if (name == "pixels")
        for (const int times : {1, 2, 4})
            add([&](Load& load) { load.size = {size.width * times / 2, size.height * times / 2}; });
    if (name == "triangles")
        for (const int copies : {1, 10, 100}) add([&](Load& load) { load.copies = copies; });
    if (name == "lights")
        for (const int lights : {1, 10, 100, 1000}) add([&](Load& load) { load.lights = lights; });
    return loads;
}

double work_of(const std::string& name, const Load& load, const Scene& scene) {
    if (name == "voxels") return double(load.voxels) * load.voxels * load.voxels;
    if (name == "pixels") return double(load.size.width) * load.size.height;
    return name == "triangles" ? static_cast<double>(triangle_count(scene)) : load.lights;
}

Result<CostSeries::Row> time(const std::string& name, const Load& load, const TimingOptions& options,
                             std::string& device) {
    Scene scene = crowded_scene(load.copies, load.lights);
    RenderSettings settings = scene.render_settings();
    settings.voxels = load.voxels;
    settings.revoxelize = Revoxelize::always;
    settings.vct.shadows = true;
    settings.vct.narrow = false;  // as while something moves
    scene.set_render_settings(std::move(settings));
    auto timer = FrameTimer::create(scene, "built-in", options);
    if (!timer) return tl::unexpected(timer.error());
    const auto frame = timer->time(load.size);
    if (!frame) return tl::unexpected(frame.error());
    device = timer->device();
    return CostSeries::Row{work_of(name, load, scene), *frame};
}

/// How much faster than its work the time grew from the row before: at most 1 where it grows no faster.
double growth(const CostSeries::Row& before, const CostSeries::Row& row) {
    return row.frame.median_ms / before.frame.median_ms * before.work / row.work;
}

}  // namespace

Result<CostReport> run_cost(const TimingOptions& options, int voxels, const std::vector<std::string>& names) {
    CostReport report;
    report.voxels = voxels;
    for (const std::string& name : names) {
        CostSeries series{name, {}};
        ProgressBar bar("bench " + name);
        const Progress progress = bar.callback();
        const std::vector<Load> loads = loads_of(name, options.size, voxels);
        for (const Load& load : loads) {
            if (!progress(static_cast<double>(series.rows.size()) / loads.size())) return fail("", "interrupted");
            const auto row = time(name, load, options, report.device);
            if (!row) return tl::unexpected(row.error());
            series.rows.push_back(*row);
        }
        report.series.push_back(std::move(series));
    }
    return report;
}

std::string as_text(const CostReport& report, const TimingOptions& options) {
    std::string text =
        fmt::format("cost: {}, {}x{}, {}³ voxels, milliseconds a frame on the GPU, median of {} frames\n",
                    report.device, options.size.width, options.size.height, report.voxels, options.frames);
    for (const CostSeries& series : report.series) {
        text += fmt::format("\n{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}{:>14}\n", series.name, "frame", "shadow map",
                            "voxelize", "filter", "cone trace", "rest", "time / work");
        for (std::size_t i = 0; i < series.rows.size(); ++i) {
            const CostSeries::Row& row = series.rows[i];
            const FrameSteps& steps = row.frame.steps;
            text += fmt::format("{:>12.0f}{:>12.3f}{:>12.3f}{:>12.3f}{:>12.3f}{:>12.3f}{:>12.3f}{:>14}\n", row.work,
                                row.frame.median_ms, steps.shadow_map_ms, steps.voxelize_ms, steps.filter_ms,
                                steps.cone_trace_ms, steps.rest_ms,
                                i == 0 ? "" : fmt::format("{:.3f}", growth(series.rows[i - 1], row)));
        }
    }
    return text + "\ntime / work: growth of the frame's time over that of the work, from the row before\n";
}

std::string as_json(const CostReport& report, const TimingOptions& options) {
    ordered_json series = ordered_json::array();
    for (const CostSeries& one : report.series) {
        ordered_json rows = ordered_json::array();
        for (std::size_t i = 0; i < one.rows.size(); ++i) {
            const CostSeries::Row& row = one.rows[i];
            rows.push_back({{one.name, row.work},
                            {"frame_mean_ms", row.frame.mean_ms},
                            {"frame_median_ms", row.frame.median_ms},
                            {"steps", steps_json(row.frame.steps)},
                            {"time_over_work", i == 0 ? ordered_json() : ordered_json(growth(one.rows[i - 1], row))}});
        }
        series.push_back({{"work", one.name}, {"rows", std::move(rows)}});
    }
    const ordered_json all = {{"benchmark", "cost"},         {"device", report.device},
                              {"width", options.size.width}, {"height", options.size.height},
                              {"voxels", report.voxels},     {"frames_timed", options.frames},
                              {"series", std::move(series)}};
    return all.dump(2) + "\n";
}

}  // namespace heliodon::cli
