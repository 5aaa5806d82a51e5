#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/cli/commands.h"
#include "app/cli/display_options.h"
#include "app/cli/gi_options.h"
#include "app/cli/option_values.h"
#include "app/cli/outputs.h"
#include "app/cli/probe.h"
#include "app/cli/scene_argument.h"
#include "app/cli/terminal.h"
#include "core/image_io.h"
#include "realtime/renderer.h"
#include "scene/time_of_day.h"
#include "trace/path_tracer.h"

namespace heliodon::cli {
namespace {

using nlohmann::json;

struct RenderOptions {
    SceneArgument scene;
    std::vector<std::string> outputs;
    Engine engine = Engine::realtime;
    Size size;
    std::string camera;
    RealtimeSettings device;
    std::uint32_t seed = 0;
    std::optional<int> samples;
    std::optional<double> seconds;
    std::optional<double> target_error;
    bool resume = false;
    int max_depth = 0;
    std::optional<Integrator> integrator;
    int threads = 0;
    bool no_environment = false;
    GiOptions gi;
    DisplayOptions display;
    std::vector<ProbedPixel> probes;
    std::vector<std::string> aovs;
    std::string stats;
    bool json = false;
    std::optional<FrameRange> frames;
    std::optional<TimeRange> times;
    double fps = 24;
    int frames_timed = 0;
};

/// What one of the engines made, and its numbers as `--stats` has them.
struct Rendered {
    Picture picture;
    json statistics;
    std::string summary;
    bool stopped = false;  ///< before its end: the picture is what there was by then
    int samples = 0;       ///< a pixel
};

constexpr int default_samples = 64;

bool shows_illuminance(const RenderOptions& options) {
    return options.display.false_colour && options.display.false_colour->illuminance;
}
/// The layers that the engines are asked for: also the one that false colour in lux shows.
std::vector<std::string> wanted_layers(const RenderOptions& options) {
    std::vector<std::string> layers = options.aovs;
    if (shows_illuminance(options) && std::ranges::find(layers, illuminance_layer_name) == layers.end())
        layers.emplace_back(illuminance_layer_name);
    return layers;
}

bool is_exr(const std::string& path) {
    return CLI::detail::to_lower(path).ends_with(".exr");
}
/// The output that interrupted work is stored in and taken up from, if there is one.
std::optional<std::string> resumable_output(const RenderOptions& options) {
    const auto found = std::find_if(options.outputs.begin(), options.outputs.end(), is_exr);
    if (found == options.outputs.end() || options.frames) return std::nullopt;
    return *found;
}

/// One engine behind one call; both follow the same scene object from frame to frame.
class Renderer {
public:
    virtual ~Renderer() = default;
    [[nodiscard]] virtual Result<Rendered> render(const Scene& scene, const Camera& camera,
                                                  const Progress& progress) = 0;
    /// What lies under pixels of the picture that render() made last.
    [[nodiscard]] virtual ProbeEngine probes(const Scene& scene) = 0;
};

const std::vector<std::string> probed_layers{"position", "normal"};

class PathRenderer final : public Renderer {
public:
    /// `resume`: what the output to go on from holds, where it is there.
    PathRenderer(const RenderOptions& options, std::optional<Picture> resume) : resume_(std::move(resume)) {
        options_.width = options.size.width;
        options_.height = options.size.height;
        const bool ends_otherwise = options.seconds || options.target_error;
        options_.samples_per_pixel = options.samples.value_or(ends_otherwise ? most_samples_per_pixel : default_samples);
        options_.seconds = options.seconds;
        options_.target_error = options.target_error;
        if (const auto output = resumable_output(options)) {
            options_.keep_state = options.resume ? KeepState::always : KeepState::when_stopped;
            options_.resume = resume_ ? &*resume_ : nullptr;
            options_.resume_name = *output;
        }
        options_.max_depth = options.max_depth;
        integrator_ = options.integrator;
        options_.environment = !options.no_environment;
        options_.seed = options.seed;
        options_.threads = options.threads;
        options_.aovs = wanted_layers(options);
    }

    Result<Rendered> render(const Scene& scene, const Camera& camera, const Progress& progress) override {
        if (auto updated = tracer_.update(scene); !updated) return tl::unexpected(updated.error());
        options_.integrator = integrator_.value_or(scene.render_settings().integrator);
        PathStatistics numbers;
        auto picture = tracer_.render(scene, camera, options_, &numbers, progress);
        if (!picture) return tl::unexpected(picture.error());
        const double rate = numbers.seconds > 0 ? static_cast<double>(numbers.rays) / numbers.seconds : 0;
        Rendered rendered{std::move(*picture),
                          {{"seconds", numbers.seconds},
                           {"spp", numbers.samples_per_pixel},
                           {"rays_per_second", rate},
                           {"peak_rss_bytes", peak_rss_bytes()}},
                          fmt::format("path tracer: {:.2f} s, {} samples a pixel, {:.2f} million rays a second",
                                      numbers.seconds, numbers.samples_per_pixel, rate * 1e-6),
                          numbers.stopped,
                          numbers.samples_per_pixel};
        if (numbers.target_reached) {
            rendered.statistics["spp_mean"] = numbers.mean_samples_per_pixel;
            rendered.statistics["target_reached"] = *numbers.target_reached;
            rendered.summary += fmt::format(" ({:.1f} on average); {:.1f} % of the picture within the target error",
                                            numbers.mean_samples_per_pixel, 100 * *numbers.target_reached);
        }
        return rendered;
    }

    ProbeEngine probes(const Scene& scene) override {
        PathOptions measuring;
        measuring.max_depth = options_.max_depth;
        measuring.environment = options_.environment;
        measuring.seed = options_.seed;
        measuring.samples_per_pixel = samples_a_sensor;
        return {[&scene, this](const Camera& camera, int width, int height) {
                    PathOptions one;
                    one.width = width, one.height = height, one.samples_per_pixel = 1, one.max_depth = 1, one.aovs = probed_layers;
                    return tracer_.render(scene, camera, one);
                },
                [measuring, this](const Scene& with_sensors) -> Result<std::vector<SensorReading>> {
                    if (auto updated = tracer_.update(with_sensors); !updated) return tl::unexpected(updated.error());
                    return tracer_.measure(with_sensors, measuring);
                }};
    }

private:
    static constexpr int samples_a_sensor = 4096;
    PathTracer tracer_;
    std::optional<Picture> resume_;
    std::optional<Integrator> integrator_;
    PathOptions options_;
};

class RealtimePictureRenderer final : public Renderer {
public:
    RealtimePictureRenderer(RealtimeRenderer renderer, const RenderOptions& options) : renderer_(std::move(renderer)) {
        options_.width = options.size.width;
        options_.height = options.size.height;
        options_.samples = options.samples.value_or(default_samples);
        options_.seed = options.seed;
        options_.environment = !options.no_environment;
        options_.frames_timed = options.frames_timed;
        options_.aovs = wanted_layers(options);
    }

    Result<Rendered> render(const Scene& scene, const Camera& camera, const Progress& progress) override {
        if (auto updated = renderer_.update(scene); !updated) return tl::unexpected(updated.error());
        options_.gi = scene.render_settings().gi;
        RealtimeStatistics numbers;
        auto picture = renderer_.render(scene, camera, options_, &numbers, progress);
        if (!picture) return tl::unexpected(picture.error());
        json passes = json::array();
        std::string summary = fmt::format("{}: {:.3f} ms a frame on the GPU", numbers.device, numbers.gpu_ms_total);
        for (const PassTime& pass : numbers.passes) {
            passes.push_back({{"name", pass.name}, {"gpu_ms", pass.gpu_ms}});
            summary += fmt::format("\n  {:<28}{:10.3f} ms", pass.name, pass.gpu_ms);
        }
        if (options_.gi == "none" && scene.render_settings().ambient != AmbientLight::none)
            summary += "\nlight that surroundings reflect is an approximation (render.ambient): a shell of the scene's mean albedo";
        json sky_passes = json::array();
        if (!numbers.sky_passes.empty()) summary += fmt::format("\nwhere the sky changes {:.3f} ms more", numbers.sky_gpu_ms);
        for (const PassTime& pass : numbers.sky_passes) {
            sky_passes.push_back({{"name", pass.name}, {"gpu_ms", pass.gpu_ms}});
            summary += fmt::format("\n  {:<28}{:10.3f} ms", pass.name, pass.gpu_ms);
        }
        Rendered rendered{std::move(*picture),
                          {{"gpu_ms_total", numbers.gpu_ms_total},
                           {"passes", std::move(passes)},
                           {"cpu_ms", numbers.cpu_ms},
                           {"sky_gpu_ms", numbers.sky_gpu_ms},
                           {"sky_passes", std::move(sky_passes)},
                           {"device", numbers.device},
                           {"gpu_memory_bytes", numbers.gpu_memory_bytes},
                           {"vertex_bytes", numbers.vertex_bytes},
                           {"peak_rss_bytes", peak_rss_bytes()}},
                          std::move(summary),
                          interrupted()};
        if (const auto& volumes = numbers.shadow_volumes)
            rendered.statistics["shadow_volumes"] = {{"triangles", volumes->caps},
                                                     {"edges", volumes->edges},
                                                     {"sides", volumes->sides},
                                                     {"rebuilt_ms", volumes->build_ms}};
        return rendered;
    }

    ProbeEngine probes(const Scene& scene) override {
        return {[&scene, this](const Camera& camera, int width, int height) {
                    RealtimeOptions one;
                    one.width = width, one.height = height, one.samples = 1, one.aovs = probed_layers;
                    return renderer_.render(scene, camera, one);
                },
                [this](const Scene& with_sensors) -> Result<std::vector<SensorReading>> {
                    if (auto updated = renderer_.update(with_sensors); !updated) return tl::unexpected(updated.error());
                    RealtimeOptions measuring = options_;
                    measuring.aovs.clear();
                    return renderer_.measure(with_sensors, measuring);
                }};
    }

private:
    RealtimeRenderer renderer_;
    RealtimeOptions options_;
};

Result<std::unique_ptr<Renderer>> create_renderer(const RenderOptions& options) {
    if (options.engine == Engine::path) {
        std::optional<Picture> resume;
        if (const auto output = resumable_output(options); options.resume && std::filesystem::exists(*output)) {
            auto picture = read_picture(*output);
            if (!picture) return tl::unexpected(picture.error());
            resume = std::move(*picture);
        }
        return std::make_unique<PathRenderer>(options, std::move(resume));
    }
    auto renderer = RealtimeRenderer::create(options.device);
    if (!renderer) return tl::unexpected(renderer.error());
    return std::make_unique<RealtimePictureRenderer>(std::move(*renderer), options);
}

std::vector<std::string> frame_outputs(const RenderOptions& options, int frame) {
    std::vector<std::string> paths;
    for (const std::string& path : options.outputs) paths.push_back(options.frames ? numbered_path(path, frame) : path);
    return paths;
}

/// Option values that are each right but do not go together.
void check_together(const RenderOptions& options) {
    const bool has_exr = std::any_of(options.outputs.begin(), options.outputs.end(), is_exr);
    if (!options.aovs.empty() && !has_exr)
        throw CLI::ValidationError("--aov", "expected an .exr output to hold the layers");
    if (options.engine == Engine::realtime) {
        const char* of_paths = options.seconds          ? "--seconds"
                               : options.target_error   ? "--target-error"
                               : options.resume         ? "--resume"
                               : options.max_depth != 0 ? "--max-depth"
                               : options.integrator     ? "--integrator"
                                                        : nullptr;
        if (of_paths) throw CLI::ValidationError(of_paths, "expected with --engine path");
    }
    if (options.resume && !resumable_output(options))
        throw CLI::ValidationError("--resume", options.frames ? "expected one picture, found --frames"
                                                              : "expected an .exr output to go on from");
    if (options.times && !options.frames) throw CLI::ValidationError("--time-range", "expected with --frames");
    if (!options.probes.empty() && options.frames)
        throw CLI::ValidationError("--probe", "expected one picture, found --frames");
    for (const ProbedPixel pixel : options.probes)
        if (pixel.x >= options.size.width || pixel.y >= options.size.height)
            throw CLI::ValidationError("--probe", fmt::format("expected a pixel of {}x{}, found \"{},{}\"", options.size.width,
                                                              options.size.height, pixel.x, pixel.y));
    if (options.engine == Engine::path && options.frames_timed > 0)
        throw CLI::ValidationError("--frames-timed", "expected with --engine realtime");
    if (options.engine == Engine::path && options.gi.given())
        throw CLI::ValidationError(options.gi.gi.empty() ? "--voxels" : "--gi", "expected with --engine realtime");
}

/// The layers that show the voxel volume need one.
void check_aovs(const RenderOptions& options, const Scene& scene) {
    const bool has_volume = options.engine == Engine::realtime && scene.render_settings().gi == "vct";
    for (const std::string& name : options.aovs)
        if (is_path_aov(name) && options.engine != Engine::path)
            throw CLI::ValidationError("--aov", fmt::format("{}: expected with --engine path", name));
        else if (name == "ao" && options.engine != Engine::realtime)
            throw CLI::ValidationError("--aov", "ao: expected with --engine realtime");
        else if (is_voxel_aov(name) && !has_volume)
            throw CLI::ValidationError("--aov", fmt::format("{} shows the voxel volume: expected --engine realtime "
                                                            "with --gi vct (or render.gi in the scene)", name));
}

Result<void> render_frame(Renderer& renderer, Scene& scene, const RenderOptions& options, int frame, Exposure& exposure,
                          json& statistics) {
    auto camera = choose_camera(scene, options.scene, options.camera);
    if (!camera) return tl::unexpected(camera.error());
    if (options.display.ev100) camera->ev100_override = options.display.ev100;

    ProgressBar bar(options.frames ? fmt::format("frame {}", frame) : "render");
    auto rendered = renderer.render(scene, *camera, bar.callback());
    if (!rendered) return interrupted() ? fail("", "interrupted") : tl::unexpected(rendered.error());
    const bool stopped = rendered->stopped;
    if (stopped && (options.engine == Engine::realtime || options.frames)) return fail("", "interrupted");
    const DisplaySettings display = scene.render_settings().display;
    rendered->picture.ev100 = exposure.ev100(rendered->picture.image, display.exposure, camera->ev100(), 1 / options.fps);
    rendered->picture.has_ev100 = true;
    Picture asked = rendered->picture;  // .exr files hold the layers that --aov names alone
    std::erase_if(asked.layers, [&](const Layer& layer) {
        return layer.name == illuminance_layer_name && std::ranges::find(options.aovs, layer.name) == options.aovs.end();
    });
    for (const std::string& path : frame_outputs(options, frame))
        if (auto written = write_rendered(path, is_exr(path) ? asked : rendered->picture, display, options.display); !written)
            return written;
    if (stopped) {
        const auto output = resumable_output(options);
        return fail("", fmt::format("interrupted after {} samples a pixel: {} the picture so far, {}", rendered->samples,
                                    options.outputs.size() == 1 ? options.outputs[0] + " is" : "the outputs are",
                                    output ? "and --resume goes on from " + *output : "which only an .exr can be gone on from"));
    }
    if (display.exposure.mode != ExposureMode::camera) rendered->statistics["ev100"] = rendered->picture.ev100;
    if (!options.probes.empty()) {
        auto readings = probe(scene, *camera, rendered->picture, options.probes, renderer.probes(scene));
        if (!readings) return tl::unexpected(readings.error());
        rendered->summary += "\n" + as_text(*readings);
        rendered->statistics["probes"] = as_json(*readings);
    }
    if (!options.frames) {
        say(rendered->summary);
        statistics = std::move(rendered->statistics);
    } else {
        rendered->statistics["frame"] = frame;
        statistics["frames"].push_back(std::move(rendered->statistics));
    }
    return {};
}

Result<void> render(const RenderOptions& options) {
    check_together(options);
    const FrameRange range = options.frames.value_or(FrameRange{0, 0});
    if (auto checked = check_pictures_writable(frame_outputs(options, range.first)); !checked) return checked;
    if (!options.stats.empty())
        if (auto checked = check_text_writable(options.stats); !checked) return checked;

    auto scene = load(options.scene);
    if (!scene) return tl::unexpected(scene.error());
    if (options.no_environment) put_out_sun(*scene);
    if (options.engine == Engine::realtime) {
        apply_gi_options(options.gi, options.scene, *scene);
        warn_without_effect(options.gi, *scene);
    }
    if (options.times && !scene->sky().place)
        return fail(options.scene.path, "expected a sky with latitude_deg and longitude_deg for --time-range, found none");
    apply_display_options(options.display, *scene);
    check_aovs(options, *scene);
    auto renderer = create_renderer(options);
    if (!renderer) return tl::unexpected(renderer.error());

    json statistics = json::object();
    Exposure exposure;
    std::vector<CivilTime> moments;
    if (options.times) moments = moments_between(options.times->first, options.times->last, range.last - range.first + 1);
    for (int frame = range.first; frame <= range.last; ++frame) {
        if (options.frames) scene->apply_animations(frame / options.fps);
        if (options.times) {
            scene->set_sky(sky_at(scene->sky(), moments[frame - range.first]));
            if (options.no_environment) put_out_sun(*scene);
        }
        if (auto done = render_frame(**renderer, *scene, options, frame, exposure, statistics); !done) return done;
    }
    if (options.json)
        if (auto printed = print(statistics.dump(2) + "\n"); !printed) return printed;
    if (!options.stats.empty()) return write_file_atomically(options.stats, statistics.dump(2) + "\n");
    return {};
}

void declare_engine_options(CLI::App& command, RenderOptions& options) {
    using Text = const std::string&;
    command.add_option_function<std::string>(
        "--engine", [&](Text text) { options.engine = read_engine(text); }, "realtime (default) or path");
    command.add_option("--seed", options.seed, "Seed of the samples")->check(check_not_negative);
    command.add_flag("--no-environment", options.no_environment, "The sky gives no light and is black");
    add_gi_options(command, options.gi);
    command
        .add_option("--spp", options.samples,
                    "Samples a pixel (real-time engine: frames averaged); default 64. With --seconds or --target-error: "
                    "at most")
        ->check(check_positive);
    command.add_option("--seconds", options.seconds, "Path engine: stop after this long at the latest")
        ->check(check_positive);
    command
        .add_option("--target-error", options.target_error,
                    "Path engine: stop where the relative standard error of the luminance is at most this: the root "
                    "mean square over the pixels of a block of 8x8, at the upper end of its 95 % confidence interval, "
                    "relative to the pixel's or the block's luminance, the lesser, but at least 1 % of the camera's white")
        ->check(check_positive);
    command.add_flag("--resume", options.resume,
                     "Path engine: go on from the .exr output, if it is there, and keep in it what going on needs. "
                     "Ctrl-C keeps it always");
    command
        .add_option("--max-depth", options.max_depth,
                    "Path engine: scattering events, 1 = direct light; default unlimited")
        ->check(check_not_negative);
    command.add_option_function<std::string>(
        "--integrator", [&](Text text) { options.integrator = read_integrator(text); },
        "Path engine: path or bidirectional (caustics, light from behind corners); default render.integrator of the scene");
    command.add_option("--threads", options.threads, "Path engine: threads; default all cores")
        ->check(check_positive);
    command.add_option("--device", options.device.device,
                       "Real-time engine: Vulkan device, by number or part of its name");
    command.add_flag("--validation", options.device.validation, "Real-time engine: with Vulkan's validation layer");
    command
        .add_option("--shaders", options.device.shader_directory,
                    "Real-time engine: compile the shaders of this directory")
        ->check(CLI::ExistingDirectory);
    command.add_option("--frames-timed", options.frames_timed, "Real-time engine: time so many frames after warm-up")
        ->check(check_positive);
}

void declare_picture_options(CLI::App& command, RenderOptions& options) {
    using Text = const std::string&;
    command
        .add_option("-o,--output", options.outputs,
                    ".exr .hdr .pfm (measured values) .png .jpg (tone-mapped); may be repeated")
        ->required()
        ->allow_extra_args(false);
    command.add_option_function<std::string>(
        "--size", [&](Text text) { options.size = read_size(text); }, "WIDTHxHEIGHT; default 1024x768");
    command.add_option("--camera", options.camera, "Name of the camera; default the first");
    add_display_options(command, options.display);
    command
        .add_option_function<std::vector<std::string>>(
            "--probe",
            [&](const std::vector<std::string>& pixels) {
                for (Text pixel : pixels) options.probes.push_back(read_pixel(pixel));
            },
            "X,Y of a pixel: luminance, and illuminance of the surface there; may be repeated")
        ->allow_extra_args(false);
    command.add_option_function<std::string>(
        "--aov", [&](Text text) { options.aovs = read_aovs(text); },
        "Extra EXR layers: albedo,normal,depth,position,direct,indirect,illuminance (lux on the side that is seen); with "
        "--engine path: variance (of the pixel's mean luminance), samples; with --engine realtime: ao; with --gi vct: "
        "voxels,opacity");
    command.add_option_function<std::string>(
        "--frames", [&](Text text) { options.frames = read_frames(text); },
        "FIRST..LAST of the animation, one numbered output each (### in its name)");
    command.add_option_function<std::string>(
        "--time-range", [&](Text text) { options.times = read_time_range(text); },
        "With --frames: FIRST..LAST, two moments as ISO 8601 that the frames' sky goes through");
    command.add_option("--fps", options.fps, "Frames a second of the animation; default 24")
        ->check(check_positive);
    command.add_option("--stats", options.stats, "Write the numbers of the run to this JSON file");
    command.add_flag("--json", options.json, "Print the numbers of the run as JSON");
}

}  // namespace

Action declare_render(CLI::App& command) {
    auto options = std::make_shared<RenderOptions>();
    add_scene_argument(command, options->scene);
    add_time_option(command, options->scene);
    declare_picture_options(command, *options);
    declare_engine_options(command, *options);
    return [options] { return render(*options); };
}

}  // namespace heliodon::cli
