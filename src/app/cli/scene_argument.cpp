#include "app/cli/scene_argument.h"

#include <CLI/CLI.hpp>

#include "app/cli/terminal.h"
#include "import/import.h"

namespace heliodon::cli {

void add_override_option(CLI::App& command, SceneArgument& argument) {
    command
        .add_option("--set", argument.overrides,
                    "PATH=VALUE: override a field of the scene file (render.gi=none, nodes.bulb.light.flux_lm=900)")
        ->allow_extra_args(false)
        ->check([](const std::string& text) {
            const std::size_t equals = text.find('=');
            return equals == std::string::npos || equals == 0 ? "expected PATH=VALUE, found \"" + text + "\"" : "";
        });
}

void add_time_option(CLI::App& command, SceneArgument& argument) {
    command.add_option("--time", argument.time,
                       "Moment as ISO 8601 with its offset (2026-03-21T09:00:00+01:00): puts the sky's sun where it stands "
                       "then, in the place of sky.time and sky.sun");
}

CLI::Option* add_scene_argument(CLI::App& command, SceneArgument& argument) {
    CLI::Option* scene =
        command.add_option("SCENE", argument.path, "A scene file (*.heliodon.json) a model (.obj, .gltf, .glb) or a luminaire (.ies, .ldt)")
            ->required();
    add_override_option(command, argument);
    return scene;
}

Result<Scene> load(const SceneArgument& argument, Warnings& warnings) {
    std::vector<Override> overrides;
    for (const std::string& text : argument.overrides) {
        const std::size_t equals = text.find('=');
        overrides.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
    if (!argument.time.empty()) overrides.push_back({"sky.time", argument.time, "--time " + argument.time});
    return load_scene(argument.path, overrides, warnings);
}

Result<Scene> load(const SceneArgument& argument) {
    Warnings warnings;
    auto scene = load(argument, warnings);
    if (scene) report_warnings(warnings);
    return scene;
}

void put_out_sun(Scene& scene) {
    Sky sky = scene.sky();
    if (!sky.is_daylight() || !sky.sun_disc) return;
    sky.sun_disc = false;
    scene.set_sky(sky);
}

Result<Camera> choose_camera(const Scene& scene, const SceneArgument& argument, const std::string& name) {
    if (scene.cameras().size() == 0) return fail(argument.path, "expected at least one camera, found none");
    std::optional<Camera> chosen;
    std::string names;
    scene.cameras().each([&](CameraId, const Camera& camera) {
        if (!chosen && (name.empty() || camera.name == name)) chosen = camera;
        names += (names.empty() ? "\"" : ", \"") + camera.name + "\"";
    });
    if (!chosen) return fail(argument.path, "expected a camera named \"" + name + "\", found " + names);
    return *chosen;
}

}  // namespace heliodon::cli
