// The program: heliodon COMMAND. Exit codes: 0 done, 1 bad input or failed, 2 wrong usage, 130 interrupted.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/terminal.h"

namespace heliodon::cli {
namespace {

struct Command {
    const char* name;
    const char* does;
    Action (*declare)(CLI::App&);
};

constexpr Command commands[] = {
    {"view", "Look at a scene in a window", declare_view},
    {"render", "Render one picture, or the frames of an animation", declare_render},
    {"measure", "Measure the scene's sensors, in lux or cd/m²", declare_measure},
    {"compare", "Compute error metrics between two pictures", declare_compare},
    {"sun", "Say where the sun stands at a place and time, when it rises and sets, and how bright it makes the day", declare_sun},
    {"bench", "Measure the field's published tables on this machine", declare_bench},
    {"info", "Say what a scene holds and what was approximated on import", declare_info},
    {"devices", "List the Vulkan devices and what each supports", declare_devices},
};

constexpr int exit_failed = 1;
constexpr int exit_usage = 2;
constexpr int exit_interrupted = 128 + 2;  // as a shell reports SIGINT

/// CLI11 would answer an unknown command with "a subcommand is required".
void check_command_name(int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    const std::string name = argv[1];
    if (std::any_of(std::begin(commands), std::end(commands), [&](const Command& c) { return name == c.name; })) return;
    std::string known;
    for (const Command& command : commands) known += std::string(known.empty() ? "" : ", ") + command.name;
    throw CLI::ExtrasError("unknown command \"" + name + "\": expected one of " + known, CLI::ExitCodes::ExtrasError);
}

int run(int argc, char** argv) {
    CLI::App app("Heliodon: a physically based renderer whose every pixel is a measurement", "heliodon");
    app.set_version_flag("--version", std::string("heliodon ") + HELIODON_VERSION);
    app.require_subcommand(1);
    Action action;
    for (const Command& command : commands) {
        CLI::App& sub = *app.add_subcommand(command.name, command.does);
        sub.parse_complete_callback([&action, run = command.declare(sub)] { action = run; });
    }
    try {
        check_command_name(argc, argv);
        app.parse(argc, argv);
        if (const auto done = action(); !done) {
            report_error(done.error());
            return interrupted() ? exit_interrupted : exit_failed;
        }
        return 0;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
        const auto parsed = app.get_subcommands();
        const std::string help = parsed.empty() ? "heliodon" : "heliodon " + parsed.front()->get_name();
        report_error({"", std::string(error.what()) + " (see " + help + " --help)"});
        return exit_usage;
    }
}

}  // namespace
}  // namespace heliodon::cli

int main(int argc, char** argv) {
    try {
        return heliodon::cli::run(argc, argv);
    } catch (const std::bad_alloc&) {
        heliodon::cli::report_error({"", "out of memory"});
    } catch (const std::exception& error) {
        heliodon::cli::report_error({"", error.what()});
    }
    return heliodon::cli::exit_failed;
}
