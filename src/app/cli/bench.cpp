#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/cli/bench_cie171.h"
#include "app/cli/bench_cost.h"
#include "app/cli/bench_fly.h"
#include "app/cli/bench_natus.h"
#include "app/cli/bench_shadow_volumes.h"
#include "app/cli/commands.h"
#include "app/cli/terminal.h"

namespace heliodon::cli {
namespace {

struct BenchOptions {
    std::string name;
    NatusOptions natus;
    CieOptions cie;
    std::vector<std::string> scenes;
    std::string tests;        ///< as given: each benchmark has its own
    std::vector<int> voxels;  ///< empty: each benchmark's own
    std::vector<std::string> series{std::begin(cost_series), std::end(cost_series)};
    bool json = false;
};

void refuse_repeats(const std::string& option, const auto& list, const std::string& text) {
    for (auto item = list.begin(); item != list.end(); ++item)
        if (std::find(list.begin(), item, *item) != item)
            throw CLI::ValidationError(option, "expected each once, found \"" + text + "\"");
}

std::vector<int> read_grids(const std::string& text) {
    std::vector<int> grids;
    for (const std::string& grid : CLI::detail::split(text, ',')) grids.push_back(read_voxels(grid));
    refuse_repeats("--voxels", grids, text);
    return grids;
}

std::vector<int> read_tests(const std::string& text) {
    std::vector<int> tests;
    for (const std::string& test : CLI::detail::split(text, ',')) {
        if (test.size() != 1 || test[0] < '1' || test[0] > '5')
            throw CLI::ValidationError("--tests", "expected numbers from 1 to 5, found \"" + test + "\"");
        tests.push_back(test[0] - '0');
    }
    refuse_repeats("--tests", tests, text);
    return tests;
}

std::vector<std::string> read_cie_tests(const std::string& text) {
    const std::vector<std::string> known = cie_tests();
    std::vector<std::string> tests = CLI::detail::split(text, ',');
    for (const std::string& test : tests)
        if (std::find(known.begin(), known.end(), test) == known.end())
            throw CLI::ValidationError("--tests", "expected numbers from 5.2 to 5.14, found \"" + test + "\"");
    refuse_repeats("--tests", tests, text);
    return tests;
}

std::vector<FlyMode> read_modes(const std::string& text) {
    const std::vector<std::string> names = CLI::detail::split(text, ',');
    std::vector<FlyMode> modes;
    for (const std::string& name : names) {
        const auto mode =
            std::find_if(fly_modes.begin(), fly_modes.end(), [&](const FlyMode& known) { return known.key == name; });
        if (mode == fly_modes.end())
            throw CLI::ValidationError(
                "--tests",
                "expected names out of simple, sunlight, sunlight_redrawn, sunlight_volumes, found \"" + name + "\"");
        modes.push_back(*mode);
    }
    refuse_repeats("--tests", names, text);
    return modes;
}

std::vector<std::string> read_series(const std::string& text) {
    std::vector<std::string> names = CLI::detail::split(text, ',');
    for (const std::string& name : names)
        if (std::find(std::begin(cost_series), std::end(cost_series), name) == std::end(cost_series))
            throw CLI::ValidationError(
                "--series", "expected names out of voxels, pixels, triangles, lights, found \"" + name + "\"");
    refuse_repeats("--series", names, text);
    return names;
}

/// What was given as SCENE files; `--set` needs one.
std::vector<SceneArgument> scenes_of(const BenchOptions& options) {
    if (options.scenes.empty() && !options.natus.scene.overrides.empty())
        throw CLI::ValidationError("--set", "expected with --scene: the built-in scenes are no files");
    std::vector<SceneArgument> scenes(options.scenes.size(), options.natus.scene);
    for (std::size_t i = 0; i < scenes.size(); ++i) scenes[i].path = options.scenes[i];
    return scenes;
}

Result<void> bench_natus(const BenchOptions& options) {
    const std::vector<SceneArgument> scenes = scenes_of(options);
    if (scenes.size() > 1) throw CLI::ValidationError("--scene", "expected one scene for natus");
    NatusOptions natus = options.natus;
    if (!scenes.empty()) natus.scene = scenes.front();
    if (!options.voxels.empty()) natus.voxels = options.voxels;
    if (!options.tests.empty()) natus.tests = read_tests(options.tests);
    const auto report = run_natus(natus);
    if (!report) return tl::unexpected(report.error());
    return print(options.json ? as_json(*report, natus) : as_text(*report, natus));
}

Result<void> bench_cost(const BenchOptions& options) {
    if (options.voxels.size() > 1) throw CLI::ValidationError("--voxels", "expected one grid for the cost");
    const int voxels = options.voxels.empty() ? CostReport{}.voxels : options.voxels.front();
    const TimingOptions& timing = options.natus.timing;
    const auto report = run_cost(timing, voxels, options.series);
    if (!report) return tl::unexpected(report.error());
    return print(options.json ? as_json(*report, timing) : as_text(*report, timing));
}

Result<void> bench_fly(const BenchOptions& options) {
    FlyOptions fly{scenes_of(options), options.natus.timing};
    if (!options.tests.empty()) fly.modes = read_modes(options.tests);
    const auto report = run_fly(fly);
    if (!report) return tl::unexpected(report.error());
    return print(options.json ? as_json(*report, fly) : as_text(*report, fly));
}

Result<void> bench_shadow_volumes(const BenchOptions& options) {
    const std::vector<SceneArgument> scenes = scenes_of(options);
    if (scenes.size() != 1) throw CLI::ValidationError("--scene", "expected one scene for shadow-volumes");
    const ShadowVolumeOptions volumes{scenes.front(), options.natus.timing};
    const auto report = run_shadow_volumes(volumes);
    if (!report) return tl::unexpected(report.error());
    return print(options.json ? as_json(*report, volumes) : as_text(*report, volumes));
}

Result<void> bench_cie171(const BenchOptions& options) {
    CieOptions cie = options.cie;
    if (!options.tests.empty()) cie.tests = read_cie_tests(options.tests);
    const auto report = run_cie171(cie);
    if (!report) return tl::unexpected(report.error());
    return print(options.json ? as_json(*report) : as_text(*report));
}

struct Benchmark {
    std::string name;
    Result<void> (*run)(const BenchOptions&);
    std::vector<std::string> takes;  ///< options besides --json
};

const std::vector<Benchmark>& benchmarks() {
    static const std::vector<Benchmark> all{
        {"natus",
         bench_natus,
         {"--scene", "--set", "--size", "--voxels", "--tests", "--frames", "--path-seconds", "--device"}},
        {"fly", bench_fly, {"--scene", "--set", "--size", "--tests", "--frames", "--device"}},
        {"cost", bench_cost, {"--size", "--voxels", "--series", "--frames", "--device"}},
        {"cie171", bench_cie171, {"--tests", "--target-error", "--seed"}},
        {"shadow-volumes", bench_shadow_volumes, {"--scene", "--set", "--size", "--frames", "--device"}}};
    return all;
}

std::string list_of(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
    return text;
}

const Benchmark* find_benchmark(const std::string& name) {
    const auto found = std::ranges::find(benchmarks(), name, &Benchmark::name);
    return found == benchmarks().end() ? nullptr : &*found;
}

/// An option that would change nothing is a mistake.
void refuse_options_of_others(const CLI::App& command, const std::string& name) {
    for (const CLI::Option* option : command.get_options()) {
        const std::string given = option->get_name();
        std::vector<std::string> takers;
        for (const Benchmark& benchmark : benchmarks())
            if (std::ranges::find(benchmark.takes, given) != benchmark.takes.end()) takers.push_back(benchmark.name);
        if (option->count() > 0 && !takers.empty() && std::ranges::find(takers, name) == takers.end())
            throw CLI::ValidationError(given, "expected with " + list_of(takers) + ", found with " + name);
    }
}

}  // namespace

Action declare_bench(CLI::App& command) {
    using Text = const std::string&;
    auto options = std::make_shared<BenchOptions>();
    NatusOptions& natus = options->natus;
    command
        .add_option(
            "NAME", options->name,
            "natus: five pictures of voxel cone tracing; fly: frames a second by sun and sky; cost: a frame's time "
            "as its work grows; cie171: the path tracer by the test cases of CIE 171:2006; shadow-volumes: those "
            "behind lit "
            "triangles against those behind all")
        ->required()
        ->check([](const std::string& name) {
            std::vector<std::string> names;
            for (const Benchmark& benchmark : benchmarks()) names.push_back(benchmark.name);
            return find_benchmark(name) ? "" : "expected " + list_of(names) + ", found \"" + name + "\"";
        });
    command.add_option(
        "--scene", options->scenes,
        "Scene files instead of the built-in scenes. natus: one, test 5's is NAME-emissive beside it; fly: any "
        "number; shadow-volumes: one");
    add_override_option(command, natus.scene);
    command.add_option_function<std::string>(
        "--size", [&natus](Text text) { natus.timing.size = read_size(text); }, "WIDTHxHEIGHT; default 1024x768");
    command.add_option_function<std::string>(
        "--voxels", [options = options.get()](Text text) { options->voxels = read_grids(text); },
        "natus: grids to measure, voxels an edge; default 256,128,64; cost: one grid; default 128");
    command.add_option(
        "--tests", options->tests,
        "natus: which of the tests, default 1,2,3,4,5 (the path tracer is compared with test 4); cie171: "
        "which of 5.2 to 5.14, default all; fly: which of simple, sunlight, sunlight_redrawn, sunlight_volumes, "
        "default all");
    command
        .add_option("--target-error", options->cie.target_error,
                    "cie171: 95 % half-width over value at which a point is done; default 0.002")
        ->check(check_positive);
    command.add_option("--seed", options->cie.seed, "cie171: seed of the samples")->check(check_not_negative);
    command.add_option("--frames", natus.timing.frames, "Frames to time of each, after warm-up; default 50")
        ->check(check_positive);
    command
        .add_option("--path-seconds", natus.path_seconds,
                    "natus: how long to trace paths for the comparison at equal error; default 60, 0: none")
        ->check(check_not_negative);
    command.add_option_function<std::string>(
        "--series", [&series = options->series](Text text) { series = read_series(text); },
        "cost: what grows; default voxels,pixels,triangles,lights");
    command.add_option("--device", natus.timing.device.device, "Vulkan device, by number or part of its name");
    command.add_flag("--json", options->json, "Print JSON");
    return [options, &command] {
        refuse_options_of_others(command, options->name);
        return find_benchmark(options->name)->run(*options);
    };
}

}  // namespace heliodon::cli
