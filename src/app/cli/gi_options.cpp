#include "app/cli/gi_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/cli/option_values.h"
#include "app/cli/terminal.h"

namespace heliodon::cli {

void add_gi_options(CLI::App& command, GiOptions& options) {
    using Text = const std::string&;
    command.add_option_function<std::string>(
        "--gi", [&](Text text) { options.gi = read_gi(text); },
        "Global illumination in real time: none or vct (voxel cone tracing); default as the scene says");
    command.add_option_function<std::string>(
        "--voxels", [&](Text text) { options.voxels = read_voxels(text); },
        "Voxels an edge of the volume: 32, 64, 128, 256 or 512; default as the scene says");
}

void apply_gi_options(const GiOptions& options, const SceneArgument& argument, Scene& scene) {
    RenderSettings settings = scene.render_settings();
    if (!options.gi.empty()) settings.gi = options.gi;
    if (options.voxels != 0) settings.voxels = options.voxels;
    if (settings.gi != "none" && settings.gi != "vct") {
        report_warnings({{argument.path, fmt::format("render.gi \"{}\" is not in this version: rendering direct light",
                                                     settings.gi)}});
        settings.gi = "none";
    }
    scene.set_render_settings(std::move(settings));
}

void warn_without_effect(const GiOptions& options, const Scene& scene) {
    if (options.voxels != 0 && scene.render_settings().gi == "none")
        report_warnings({{"--voxels", "has no effect without global illumination (see --gi)"}});
}

}  // namespace heliodon::cli
