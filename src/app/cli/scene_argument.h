#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "scene/scene.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace heliodon::cli {

/// `SCENE`, `--set PATH=VALUE` and `--time`, which several commands take.
struct SceneArgument {
    std::string path;
    std::vector<std::string> overrides;
    std::string time;  ///< instead of the sky's own time and sun; empty: as the file has it
};

/// Declares `--set` alone.
void add_override_option(CLI::App& command, SceneArgument& argument);
/// Declares `--time`.
void add_time_option(CLI::App& command, SceneArgument& argument);
/// Declares SCENE and `--set` and returns SCENE, which is required unless the caller says otherwise.
CLI::Option* add_scene_argument(CLI::App& command, SceneArgument& argument);
[[nodiscard]] Result<Scene> load(const SceneArgument& argument, Warnings& warnings);
/// The same, with its warnings reported on standard error.
[[nodiscard]] Result<Scene> load(const SceneArgument& argument);
/// The sky's sun shines no more.
void put_out_sun(Scene& scene);
/// The camera of that name, or the scene's first where `name` is empty.
[[nodiscard]] Result<Camera> choose_camera(const Scene& scene, const SceneArgument& argument, const std::string& name);

}  // namespace heliodon::cli
