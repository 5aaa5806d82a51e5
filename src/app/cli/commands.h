#pragma once

#include <functional>

#include "core/result.h"

namespace CLI {
class App;
}

namespace heliodon::cli {

/// Does the command's work once its options are read. Wrong options found only then are thrown as
/// CLI::ParseError, like the ones that CLI11 finds; everything else comes back as an Error.
using Action = std::function<Result<void>()>;

/// Each declares a command's options on `command` and returns what runs it; one file a command.
[[nodiscard]] Action declare_view(CLI::App& command);
[[nodiscard]] Action declare_render(CLI::App& command);
[[nodiscard]] Action declare_measure(CLI::App& command);
[[nodiscard]] Action declare_compare(CLI::App& command);
[[nodiscard]] Action declare_sun(CLI::App& command);
[[nodiscard]] Action declare_bench(CLI::App& command);
[[nodiscard]] Action declare_info(CLI::App& command);
[[nodiscard]] Action declare_devices(CLI::App& command);

}  // namespace heliodon::cli
