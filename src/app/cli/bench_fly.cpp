#include "app/cli/bench_fly.h"

#include <fmt/format.h>

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/cli/bench_scene.h"
#include "app/cli/fly_models.h"
#include "app/cli/terminal.h"
#include "shading/sky.h"

namespace heliodon::cli {
namespace {

using nlohmann::ordered_json;

constexpr float sun_azimuth_rad = glm::radians(130.0f), sun_elevation_rad = glm::radians(45.0f);
// A morning's sun and sky in one number each: what the modes with a sky of their own cost does not depend on them.
constexpr float sun_lux = 80000, even_sky_nits = 4000;

void put_out_lamps(Scene& scene) {
    std::vector<NodeId> lamps;
    scene.nodes().each([&](NodeId id, const Node& node) {
        if (node.light) lamps.push_back(id);
    });
    for (const NodeId lamp : lamps) scene.set_light(lamp, std::nullopt);
}

/// Lights a scene whose lamps are off; `sun` is a node for the directional light of the simple mode, `own` the scene's
/// own sky.
void light(Scene& scene, NodeId sun, const Sky& own, const FlyMode& mode) {
    Sky sky{.model = SkyModel::constant, .luminance_nits = glm::vec3(even_sky_nits)};
    if (mode.sunlight && own.is_daylight())
        sky = own;
    else if (mode.sunlight)
        sky = {.model = SkyModel::hosek, .sun_azimuth_rad = sun_azimuth_rad, .sun_elevation_rad = sun_elevation_rad};
    scene.set_sky(sky);
    std::optional<Light> directional;
    if (!mode.sunlight) {
        directional = Light{.type = LightType::directional, .intensity = glm::vec3(sun_lux)};
        directional->direction = -shading::direction_from_azimuth(sun_azimuth_rad, sun_elevation_rad, 0);
    }
    scene.set_light(sun, directional);
    RenderSettings settings = scene.render_settings();
    settings.gi = "none";
    settings.ambient = mode.sunlight ? AmbientLight::directional : AmbientLight::none;
    settings.ambient_occlusion.on = mode.sunlight;
    settings.sun_shadows = mode.volumes ? SunShadows::volumes : SunShadows::cascades;
    scene.set_render_settings(std::move(settings));
}

Result<FlyModel> measure(Scene scene, std::string name, std::optional<FlyPublished> published,
                         const FlyOptions& options, std::string& device) {
    FlyModel model{std::move(name), triangle_count(scene), published, {}};
    put_out_lamps(scene);
    const NodeId sun = scene.add_node({.name = "sun"});
    const Sky own = scene.sky();
    auto timer = FrameTimer::create(scene, model.name, options.timing);
    if (!timer) return tl::unexpected(timer.error());
    for (const FlyMode& mode : options.modes) {
        light(scene, sun, own, mode);
        auto frame = timer->time(options.timing.size, nullptr, mode.keep_shadows);
        if (!frame) return tl::unexpected(frame.error());
        model.frames.push_back(std::move(*frame));
    }
    device = timer->device();
    return model;
}

double frames_a_second(const FrameTime& frame) {
    return 1000 / frame.median_ms;
}

/// Of the three figures that were published, the one that a mode stands beside.
std::optional<double> published_fps(const FlyModel& model, const FlyMode& mode) {
    if (!model.published) return std::nullopt;
    return mode.sunlight ? model.published->sunlight_fps : model.published->simple_fps;
}

constexpr const char* light_maps_missing = "not there yet";

std::string model_text(const FlyModel& model, const std::vector<FlyMode>& modes) {
    std::string text = fmt::format("\n{}: {} triangles\n{:<46}{:>10}{:>10}{:>12}\n", model.name, model.triangles, "",
                                   "ms", "fps", model.published ? "published" : "");
    const auto published = [](std::optional<double> fps) {
        return fps ? fmt::format("{:>12.0f}", *fps) : std::string();
    };
    std::map<std::string, std::string> passes;
    std::vector<std::string> order;  // of passes, as they first come
    for (std::size_t i = 0; i < model.frames.size(); ++i) {
        const FrameTime& frame = model.frames[i];
        text += fmt::format("{:<46}{:>10.3f}{:>10.0f}{}\n", modes[i].shows, frame.median_ms, frames_a_second(frame),
                            published(published_fps(model, modes[i])));
        if (i == 0)
            text +=
                fmt::format("{:<46}{:>20}{}\n", "light maps", light_maps_missing,
                            published(model.published ? std::optional(model.published->light_maps_fps) : std::nullopt));
        for (const PassTime& pass : frame.passes) {
            if (!passes.contains(pass.name)) order.push_back(pass.name);
            std::string& row = passes[pass.name];
            row.resize(14 * i, ' ');
            row += fmt::format("{:>14.3f}", pass.gpu_ms);
        }
    }
    text += fmt::format("{:<32}", "ms a pass");
    for (const FlyMode& mode : modes) text += fmt::format("{:>14}", mode.column);
    text += '\n';
    for (const std::string& name : order) text += fmt::format("{:<32}{}\n", name, passes[name]);
    return text;
}

ordered_json model_json(const FlyModel& model, const std::vector<FlyMode>& measured) {
    const auto optional = [](std::optional<double> value) { return value ? ordered_json(*value) : ordered_json(); };
    ordered_json modes = ordered_json::array();
    for (std::size_t i = 0; i < model.frames.size(); ++i) {
        const FrameTime& frame = model.frames[i];
        ordered_json passes = ordered_json::array();
        for (const PassTime& pass : frame.passes) passes.push_back({{"name", pass.name}, {"gpu_ms", pass.gpu_ms}});
        modes.push_back({{"mode", measured[i].key},
                         {"shadows_redrawn", !measured[i].keep_shadows},
                         {"shadow_maps_drawn", frame.shadow_maps_drawn},
                         {"frame_median_ms", frame.median_ms},
                         {"frame_mean_ms", frame.mean_ms},
                         {"frames_a_second", frames_a_second(frame)},
                         {"published_frames_a_second", optional(published_fps(model, measured[i]))},
                         {"passes", std::move(passes)}});
    }
    modes.push_back({{"mode", "light_maps"},
                     {"frames_a_second", nullptr},
                     {"note", light_maps_missing},
                     {"published_frames_a_second",
                      optional(model.published ? std::optional(model.published->light_maps_fps) : std::nullopt)}});
    return {{"model", model.name}, {"triangles", model.triangles}, {"modes", std::move(modes)}};
}

}  // namespace

Result<FlyReport> run_fly(const FlyOptions& options) {
    std::vector<std::pair<std::string, std::function<Result<Scene>()>>> models;
    for (const SceneArgument& scene : options.scenes) models.emplace_back(scene.path, [&scene] { return load(scene); });
    const bool built_in = models.empty();
    if (built_in)
        models = {{"garden", [] { return garden_scene(); }},
                  {"tower", [] { return tower_scene(); }},
                  {"car", [] { return car_scene(); }}};
    FlyReport report;
    ProgressBar bar("bench fly");
    const Progress progress = bar.callback();
    for (const auto& [name, make] : models) {
        const std::size_t i = report.models.size();
        if (!progress(static_cast<double>(i) / models.size())) return fail("", "interrupted");
        auto scene = make();
        if (!scene) return tl::unexpected(scene.error());
        const auto published = built_in ? std::optional(published_fly[i]) : std::nullopt;
        auto model = measure(std::move(*scene), name, published, options, report.device);
        if (!model) return tl::unexpected(model.error());
        report.models.push_back(std::move(*model));
    }
    return report;
}

std::string as_text(const FlyReport& report, const FlyOptions& options) {
    std::string text = fmt::format("fly: {}, {}x{}, frames on the GPU, median of {}\n", report.device,
                                   options.timing.size.width, options.timing.size.height, options.timing.frames);
    for (const FlyModel& model : report.models) text += model_text(model, options.modes);
    return text;
}

std::string as_json(const FlyReport& report, const FlyOptions& options) {
    ordered_json models = ordered_json::array();
    for (const FlyModel& model : report.models) models.push_back(model_json(model, options.modes));
    const ordered_json all = {{"benchmark", "fly"},
                              {"device", report.device},
                              {"width", options.timing.size.width},
                              {"height", options.timing.size.height},
                              {"frames_timed", options.timing.frames},
                              {"models", std::move(models)}};
    return all.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace heliodon::cli
