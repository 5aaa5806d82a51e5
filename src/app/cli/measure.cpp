#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <nlohmann/json.hpp>

#include "app/cli/commands.h"
#include "app/cli/false_colour.h"
#include "app/cli/gi_options.h"
#include "app/cli/option_values.h"
#include "app/cli/scene_argument.h"
#include "app/cli/terminal.h"
#include "core/image_io.h"
#include "realtime/renderer.h"
#include "scene/time_of_day.h"
#include "trace/path_tracer.h"

namespace heliodon::cli {
namespace {

struct MeasureOptions {
    SceneArgument scene;
    Engine engine = Engine::path;
    int samples = 4096;
    std::optional<double> target_error;
    std::string false_colour;  ///< file
    std::optional<TimeRange> times;
    std::optional<double> step_s;
    int max_depth = 0;
    std::uint32_t seed = 0;
    bool no_environment = false;
    GiOptions gi;
    RealtimeSettings device;
    bool json = false;
};

using Readings = std::vector<SensorReading>;

/// What an engine reads of a scene, which may have changed since the last call.
using Measuring = std::function<Result<Readings>(const Scene&, const Progress&)>;

Measuring measuring_with_paths(const MeasureOptions& options) {
    PathOptions path;
    path.samples_per_pixel = options.samples;
    path.target_error = options.target_error;
    path.max_depth = options.max_depth;
    path.seed = options.seed;
    path.environment = !options.no_environment;
    return [path, tracer = std::make_shared<PathTracer>()](const Scene& scene, const Progress& progress) -> Result<Readings> {
        if (auto updated = tracer->update(scene); !updated) return tl::unexpected(updated.error());
        return tracer->measure(scene, path, progress);
    };
}

Result<Measuring> measuring_in_real_time(const Scene& scene, const MeasureOptions& options) {
    warn_without_effect(options.gi, scene);
    auto created = RealtimeRenderer::create(options.device);
    if (!created) return tl::unexpected(created.error());
    RealtimeOptions realtime;
    realtime.seed = options.seed;
    realtime.environment = !options.no_environment;
    realtime.gi = options.max_depth == 1 ? "none" : scene.render_settings().gi;
    return [realtime, renderer = std::make_shared<RealtimeRenderer>(std::move(*created))](const Scene& changed,
                                                                                       const Progress&) -> Result<Readings> {
        if (auto updated = renderer->update(changed); !updated) return tl::unexpected(updated.error());
        return renderer->measure(changed, realtime);
    };
}

const char* type_name(SensorType type) {
    return type == SensorType::illuminance ? "illuminance" : "luminance";
}
const char* unit(SensorType type) {
    return type == SensorType::illuminance ? "lux" : "cd/m2";
}

nlohmann::json sensors_as_json(const Readings& readings) {
    nlohmann::json sensors = nlohmann::json::array();
    for (const SensorReading& reading : readings) {
        nlohmann::json sensor{{"name", reading.name},
                              {"type", type_name(reading.type)},
                              {"value", reading.value},
                              {"rgb", {reading.rgb.x, reading.rgb.y, reading.rgb.z}},
                              {"unit", unit(reading.type)},
                              {"half_width_95", reading.half_width_95}};
        if (reading.in_grid) sensor["position"] = {reading.position.x, reading.position.y, reading.position.z};
        sensors.push_back(std::move(sensor));
    }
    return sensors;
}

/// Names come from the command line too (--set), in any encoding.
std::string as_text(const nlohmann::json& json) {
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// A field as RFC 4180 quotes it.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

bool has_grid(const Readings& readings) {
    return std::any_of(readings.begin(), readings.end(), [](const SensorReading& r) { return r.in_grid; });
}

/// Where a scene has grids, the points' places stand at the end of each line; `times`: the moment at its beginning.
std::string csv_header(const Readings& readings, bool times) {
    return fmt::format("{}name,type,value,r,g,b,unit,half_width_95{}\n", times ? "time," : "", has_grid(readings) ? ",x,y,z" : "");
}
std::string as_csv(const Readings& readings, const std::string& time = {}) {
    const bool grids = has_grid(readings);
    std::string text;
    for (const SensorReading& r : readings) {
        if (!time.empty()) text += time + ",";
        text += fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.9g},{},{:.4g}", csv_field(r.name), type_name(r.type), r.value, r.rgb.x,
                            r.rgb.y, r.rgb.z, unit(r.type), r.half_width_95);
        if (grids) text += fmt::format(",{:.9g},{:.9g},{:.9g}", r.position.x, r.position.y, r.position.z);
        text += "\n";
    }
    return text;
}

/// The sensors at each moment of a range, printed as they come.
Result<void> measure_over_time(Scene& scene, const MeasureOptions& options, const Measuring& measuring) {
    if (!scene.sky().place)
        return fail(options.scene.path, "expected a sky with latitude_deg and longitude_deg for --time-range, found none");
    const std::vector<CivilTime> moments = moments_by_step(options.times->first, options.times->last, *options.step_s);
    ProgressBar bar("measure");
    const Progress progress = bar.callback();
    nlohmann::json by_time = nlohmann::json::array();
    for (std::size_t i = 0; i < moments.size(); ++i) {
        scene.set_sky(sky_at(scene.sky(), moments[i]));
        if (options.no_environment) put_out_sun(scene);
        auto readings = measuring(scene, [](double) { return !interrupted(); });
        if (interrupted() || (progress && !progress(static_cast<double>(i + 1) / static_cast<double>(moments.size()))))
            return fail("", "interrupted");
        if (!readings) return tl::unexpected(readings.error());
        const std::string time = to_iso8601(moments[i]);
        if (options.json) {
            by_time.push_back({{"time", time}, {"sensors", sensors_as_json(*readings)}});
            continue;
        }
        if (auto printed = print((i == 0 ? csv_header(*readings, true) : "") + as_csv(*readings, time)); !printed) return printed;
    }
    return options.json ? print(as_text({{"times", std::move(by_time)}})) : Result<void>{};
}

Result<void> write_false_colour(const std::string& path, const Scene& scene, const Readings& readings) {
    Picture picture;
    picture.image = draw_grids(grids_of(scene, readings));
    return write_picture(path, picture);
}

/// Option values that are each right but do not go together.
void check_together(const MeasureOptions& options) {
    if (options.engine == Engine::realtime && options.max_depth > 1)
        throw CLI::ValidationError("--max-depth", "the real-time engine counts no bounces: expected 1 (direct light)");
    if (options.engine == Engine::path && options.gi.given())
        throw CLI::ValidationError(options.gi.gi.empty() ? "--voxels" : "--gi", "expected with --engine realtime");
    if (options.engine == Engine::realtime && options.target_error)
        throw CLI::ValidationError("--target-error", "expected with --engine path");
    if (options.times.has_value() != options.step_s.has_value())
        throw CLI::ValidationError(options.times ? "--step" : "--time-range", "expected --time-range and --step together");
    if (options.times && !options.false_colour.empty())
        throw CLI::ValidationError("--false-colour", "expected one moment, found --time-range");
    if (!options.false_colour.empty() && !is_display_format(options.false_colour))
        throw CLI::ValidationError("--false-colour", "expected a .png or .jpg file, found \"" + options.false_colour + "\"");
}

Result<void> measure(const MeasureOptions& options) {
    check_together(options);
    if (!options.false_colour.empty())
        if (auto checked = check_writable(options.false_colour); !checked) return checked;
    auto scene = load(options.scene);
    if (!scene) return tl::unexpected(scene.error());
    if (options.no_environment) put_out_sun(*scene);
    if (scene->sensors().size() == 0) return fail(options.scene.path, "expected sensors to measure, found none");
    bool has_grid = false;
    scene->sensors().each([&](SensorId, const Sensor& sensor) { has_grid = has_grid || sensor.grid; });
    if (!options.false_colour.empty() && !has_grid)
        return fail(options.scene.path, "expected a grid of sensors to draw in false colour, found none");
    if (options.engine == Engine::realtime) apply_gi_options(options.gi, options.scene, *scene);
    auto measuring = options.engine == Engine::path ? measuring_with_paths(options) : measuring_in_real_time(*scene, options);
    if (!measuring) return tl::unexpected(measuring.error());
    if (options.times) return measure_over_time(*scene, options, *measuring);
    ProgressBar bar("measure");
    auto readings = (*measuring)(*scene, bar.callback());
    if (interrupted()) return fail("", "interrupted");
    if (!readings) return tl::unexpected(readings.error());
    if (!options.false_colour.empty())
        if (auto written = write_false_colour(options.false_colour, *scene, *readings); !written) return written;
    return print(options.json ? as_text({{"sensors", sensors_as_json(*readings)}}) : csv_header(*readings, false) + as_csv(*readings));
}

}  // namespace

Action declare_measure(CLI::App& command) {
    auto options = std::make_shared<MeasureOptions>();
    add_scene_argument(command, options->scene);
    add_time_option(command, options->scene);
    command.add_option_function<std::string>(
        "--engine", [options = options.get()](const std::string& text) { options->engine = read_engine(text); },
        "path (default) or realtime");
    command.add_option("--spp", options->samples, "Path engine: samples a sensor (at least, with --target-error); default 4096")
        ->check(check_positive);
    command.add_option("--target-error", options->target_error,
                       "Path engine: sample each sensor on until its 95 % half-width is this share of its value")
        ->check(check_positive);
    command.add_option("--false-colour", options->false_colour,
                       "Draw the scene's grids with iso-lines and a legend into this PNG or JPEG");
    command.add_option_function<std::string>(
        "--time-range", [options = options.get()](const std::string& text) { options->times = read_time_range(text); },
        "FIRST..LAST, two moments as ISO 8601: the sensors at each --step from the one to the other");
    command.add_option_function<std::string>(
        "--step", [options = options.get()](const std::string& text) { options->step_s = read_duration(text); },
        "With --time-range: 30s, 15min, 1h or 1d");
    command.add_option("--max-depth", options->max_depth, "Scattering events, 1 = direct light; default unlimited")
        ->check(check_not_negative);
    command.add_option("--seed", options->seed, "Seed of the samples")->check(check_not_negative);
    command.add_flag("--no-environment", options->no_environment, "The sky gives no light");
    add_gi_options(command, options->gi);
    command.add_option("--device", options->device.device,
                       "Real-time engine: Vulkan device, by number or part of its name");
    command.add_flag("--json", options->json, "Print JSON instead of CSV");
    return [options] { return measure(*options); };
}

}  // namespace heliodon::cli
