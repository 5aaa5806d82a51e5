#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/cli/bench_natus.h"
#include "app/cli/commands.h"
#include "app/cli/terminal.h"

namespace heliodon::cli {
namespace {

struct BenchOptions {
    std::string name;
    NatusOptions natus;
    bool json = false;
};

std::vector<int> read_grids(const std::string& text) {
    std::vector<int> grids;
    for (const std::string& grid : CLI::detail::split(text, ',')) grids.push_back(read_voxels(grid));
    for (auto grid = grids.begin(); grid != grids.end(); ++grid)
        if (std::find(grids.begin(), grid, *grid) != grid)
            throw CLI::ValidationError("--voxels", "expected each grid once, found \"" + text + "\"");
    return grids;
}

Result<void> bench(const BenchOptions& options) {
    if (options.natus.scene.path.empty() && !options.natus.scene.overrides.empty())
        throw CLI::ValidationError("--set", "expected with --scene: the built-in scene is no file");
    const auto report = run_natus(options.natus);
    if (!report) return tl::unexpected(report.error());
    return print(options.json ? as_json(*report, options.natus) : as_text(*report, options.natus));
}

}  // namespace

Action declare_bench(CLI::App& command) {
    using Text = const std::string&;
    auto options = std::make_shared<BenchOptions>();
    NatusOptions& natus = options->natus;
    command.add_option("NAME", options->name, "natus: five pictures of voxel cone tracing")
        ->required()
        ->check([](const std::string& name) {
            return name == "natus" ? "" : "expected natus, found \"" + name + "\"";
        });
    command.add_option("--scene", natus.scene.path,
                       "Scene file instead of the built-in scene; the one lit by its wall is NAME-emissive beside it");
    add_override_option(command, natus.scene);
    command.add_option_function<std::string>(
        "--size", [&natus](Text text) { natus.timing.size = read_size(text); }, "WIDTHxHEIGHT; default 1024x768");
    command.add_option_function<std::string>(
        "--voxels", [&natus](Text text) { natus.voxels = read_grids(text); },
        "Grids to measure, voxels an edge; default 256,128,64");
    command.add_option("--frames", natus.timing.frames, "Frames to time of each, after warm-up; default 50")
        ->check(check_positive);
    command.add_option("--path-seconds", natus.path_seconds,
                       "How long to trace the reference for the comparison at equal error; default 60, 0: none")
        ->check(check_not_negative);
    command.add_option("--device", natus.timing.device.device, "Vulkan device, by number or part of its name");
    command.add_flag("--json", options->json, "Print JSON");
    return [options] { return bench(*options); };
}

}  // namespace heliodon::cli
