#include "app/cli/bench_cie171.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/cli/terminal.h"
#include "trace/path_tracer.h"

namespace heliodon::cli {
namespace {

using Readings = std::vector<SensorReading>;

/// Largest errors that Blender's Cycles is reported with, in percent (github.com/jjathompson4/CyclesCIEtest).
const std::map<std::string, double> published_cycles_percent{{"5.2", .99}, {"5.3", 4.94}, {"5.4", .28},
                                                             {"5.6", .25}, {"5.7", 1.07}, {"5.8", .31}};

Result<Readings> measure(const Scene& scene, const PathOptions& options) {
    PathTracer tracer;
    if (auto updated = tracer.update(scene); !updated) return tl::unexpected(updated.error());
    return tracer.measure(scene, options, [](double) { return !interrupted(); });
}

Result<CieSceneReport> run_scene(const CieScene& scene, const CieOptions& options) {
    PathOptions path;
    // A rougher run begins with fewer samples, too.
    path.samples_per_pixel =
        std::max(32, static_cast<int>(scene.samples * std::clamp(full_target_error / options.target_error, 1.0 / 16, 1.0)));
    path.target_error = options.target_error * scene.error_share;
    path.target_floor = scene.floor / scene.scale;
    path.max_depth = scene.max_depth;
    path.seed = options.seed;
    auto readings = measure(scene.scene, path);
    if (!readings) return tl::unexpected(readings.error());
    Readings direct;
    if (scene.indirect) {
        path.max_depth = 1;
        auto measured = measure(scene.scene, path);
        if (!measured) return tl::unexpected(measured.error());
        direct = std::move(*measured);
    }
    if (interrupted()) return fail("", "interrupted");
    CieSceneReport report{scene.test, scene.variant, scene.unit, {}};
    for (const CiePoint& point : scene.points) {
        CieResult result{point.name, point.exact, 0, 0};
        double variance = 0;
        for (const auto& [sensor, weight] : point.sensors) {
            result.value += scene.scale * weight * ((*readings)[sensor].value - (scene.indirect ? direct[sensor].value : 0));
            variance += std::pow(scene.scale * weight * (*readings)[sensor].half_width_95, 2);
            if (scene.indirect) variance += std::pow(scene.scale * weight * direct[sensor].half_width_95, 2);
        }
        result.half_width_95 = std::sqrt(variance);
        report.points.push_back(std::move(result));
    }
    return report;
}

/// All scenes of one test together; relative numbers of its points that are not zero.
struct Summary {
    int points = 0, zeros = 0;
    double worst = 0, mean = 0, half_width = 0, worst_zero = 0;
    std::string worst_point;
};

Summary summarize(const CieReport& report, const std::string& test) {
    Summary summary;
    for (const CieSceneReport& scene : report.scenes) {
        if (scene.test != test) continue;
        for (const CieResult& point : scene.points) {
            const double error = std::abs(point.error());
            if (point.exact == 0) {
                ++summary.zeros;
                summary.worst_zero = std::max(summary.worst_zero, error);
                continue;
            }
            ++summary.points;
            summary.mean += error;
            summary.half_width = std::max(summary.half_width, point.relative_half_width());
            if (error < summary.worst && summary.points > 1) continue;
            summary.worst = error;
            summary.worst_point = scene.variant.empty() ? point.name : scene.variant + ", " + point.name;
        }
    }
    summary.mean /= std::max(1, summary.points);
    return summary;
}

std::vector<std::string> tests_of(const CieReport& report) {
    std::vector<std::string> tests;
    for (const CieSceneReport& scene : report.scenes)
        if (tests.empty() || tests.back() != scene.test) tests.push_back(scene.test);
    return tests;
}

}  // namespace

Result<CieReport> run_cie171(const CieOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<CieScene> scenes;
    for (const std::string& test : options.tests)
        for (CieScene& scene : cie_scenes(test)) scenes.push_back(std::move(scene));
    CieReport report;
    ProgressBar bar("cie171");
    const Progress progress = bar.callback();
    for (const CieScene& scene : scenes) {
        auto measured = run_scene(scene, options);
        if (!measured) return tl::unexpected(measured.error());
        report.scenes.push_back(std::move(*measured));
        (void)progress(static_cast<double>(report.scenes.size()) / static_cast<double>(scenes.size()));
    }
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

std::string as_text(const CieReport& report) {
    std::string text =
        "| test | points | largest error | mean error | largest 95 % half-width | where the error is largest | zeros | "
        "Cycles, published |\n|---|---|---|---|---|---|---|---|\n";
    for (const std::string& test : tests_of(report)) {
        const Summary s = summarize(report, test);
        const auto cycles = published_cycles_percent.find(test);
        text += fmt::format("| {} | {} | {:.3f} % | {:.3f} % | {:.3f} % | {} | {} | {} |\n", test, s.points, 100 * s.worst,
                            100 * s.mean, 100 * s.half_width, s.worst_point,
                            s.zeros ? fmt::format("{}: {:.4f}", s.zeros, s.worst_zero) : "",
                            cycles == published_cycles_percent.end() ? "" : fmt::format("{:g} %", cycles->second));
    }
    return text + fmt::format("{:.0f} s\n", report.seconds);
}

std::string as_json(const CieReport& report) {
    using Json = nlohmann::ordered_json;
    Json tests = Json::array(), scenes = Json::array();
    for (const std::string& test : tests_of(report)) {
        const Summary s = summarize(report, test);
        Json entry{{"test", test},
                   {"points", s.points},
                   {"largest_error_percent", 100 * s.worst},
                   {"mean_error_percent", 100 * s.mean},
                   {"largest_half_width_95_percent", 100 * s.half_width},
                   {"where", s.worst_point},
                   {"zeros", s.zeros},
                   {"largest_zero", s.worst_zero}};
        if (const auto cycles = published_cycles_percent.find(test); cycles != published_cycles_percent.end())
            entry["cycles_published_percent"] = cycles->second;
        tests.push_back(std::move(entry));
    }
    for (const CieSceneReport& scene : report.scenes) {
        Json points = Json::array();
        for (const CieResult& point : scene.points)
            points.push_back({{"name", point.name},
                              {"exact", point.exact},
                              {"value", point.value},
                              {"half_width_95", point.half_width_95}});
        scenes.push_back({{"test", scene.test}, {"variant", scene.variant}, {"unit", scene.unit}, {"points", std::move(points)}});
    }
    return Json{{"tests", std::move(tests)}, {"scenes", std::move(scenes)}, {"seconds", report.seconds}}.dump(2) + "\n";
}

}  // namespace heliodon::cli
