#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "app/cli/commands.h"
#include "app/cli/gi_options.h"
#include "app/cli/option_values.h"
#include "app/cli/scene_argument.h"
#include "app/editor/viewer.h"

namespace heliodon::cli {
namespace {

struct ViewOptions {
    SceneArgument scene;
    GiOptions gi;
    editor::ViewerSettings settings;
};

/// The built-in scene lies beside the program: ../share/heliodon/assets from where the executable is.
Result<std::string> default_scene() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) return fail("/proc/self/exe", error.message());
    return (program.parent_path().parent_path() / "share/heliodon/assets/default.heliodon.json").string();
}

Result<void> view(ViewOptions options) {
    if (options.scene.path.empty()) {
        auto path = default_scene();
        if (!path) return tl::unexpected(path.error());
        options.scene.path = *path;
    }
    auto scene = load(options.scene);
    if (!scene) return tl::unexpected(scene.error());
    apply_gi_options(options.gi, options.scene, *scene);
    return editor::view(std::move(*scene), options.settings);
}

}  // namespace

Action declare_view(CLI::App& command) {
    auto options = std::make_shared<ViewOptions>();
    add_scene_argument(command, options->scene)->required(false);
    add_time_option(command, options->scene);
    command.add_option_function<std::string>(
        "--size",
        [settings = &options->settings](const std::string& text) {
            const Size size = read_size(text);
            settings->width = size.width;
            settings->height = size.height;
        },
        "WIDTHxHEIGHT of the window; default 1280x720");
    add_gi_options(command, options->gi);
    command.add_option("--camera", options->settings.camera, "Name of the camera to begin with; default the first");
    command.add_option("--device", options->settings.device, "Vulkan device, by number or part of its name");
    command
        .add_option("--shaders", options->settings.shader_directory,
                    "Compile the shaders of this directory; F5 reloads them")
        ->check(CLI::ExistingDirectory);
    command.add_flag("--validation", options->settings.validation, "With Vulkan's validation layer");
    return [options] { return view(*options); };
}

}  // namespace heliodon::cli
