#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/cli/commands.h"

namespace heliodon::cli {

Action declare_view(CLI::App& command) {
    auto scene = std::make_shared<std::string>();
    command.add_option("SCENE", *scene, "A scene file or a model; default the built-in scene");
    return [scene]() -> Result<void> { return fail("", "built without the viewer"); };
}

}  // namespace heliodon::cli
