#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cli/commands.h"
#include "app/cli/terminal.h"
#include "realtime/renderer.h"

namespace heliodon::cli {
namespace {

std::string as_json(const std::vector<DeviceInfo>& devices) {
    nlohmann::ordered_json entries = nlohmann::ordered_json::array();
    for (const DeviceInfo& d : devices)
        entries.push_back({{"number", d.number},
                           {"name", d.name},
                           {"driver", d.driver},
                           {"api_version", d.api_version},
                           {"is_cpu", d.is_cpu},
                           {"usable", d.usable},
                           {"missing", d.missing},
                           {"ray_query", d.ray_query},
                           {"ray_tracing_pipeline", d.ray_tracing_pipeline},
                           {"mesh_shader", d.mesh_shader},
                           {"conservative_rasterization", d.conservative_rasterization},
                           {"memory_bytes", d.memory_bytes}});
    return nlohmann::ordered_json{{"devices", std::move(entries)}}.dump(2) + "\n";
}

std::string as_text(const std::vector<DeviceInfo>& devices) {
    std::string text;
    for (const DeviceInfo& d : devices) {
        text +=
            fmt::format("{}  {} ({}, Vulkan {}, {:.1f} GiB{})\n", d.number, d.name, d.driver, d.api_version,
                        static_cast<double>(d.memory_bytes) / (1024.0 * 1024.0 * 1024.0), d.is_cpu ? ", a CPU" : "");
        if (!d.usable) text += fmt::format("   not usable: {}\n", d.missing);
        const auto yes_no = [](bool has) { return has ? "yes" : "no"; };
        text += fmt::format("   ray query {}, ray tracing pipeline {}, mesh shader {}, conservative rasterization {}\n",
                            yes_no(d.ray_query), yes_no(d.ray_tracing_pipeline), yes_no(d.mesh_shader),
                            yes_no(d.conservative_rasterization));
    }
    return text;
}

Result<void> devices(bool json) {
    auto found = list_devices();
    if (!found) return tl::unexpected(found.error());
    if (found->empty()) return fail("", "expected a Vulkan device, found none (Mesa's lavapipe runs on any CPU)");
    return print(json ? as_json(*found) : as_text(*found));
}

}  // namespace

Action declare_devices(CLI::App& command) {
    auto json = std::make_shared<bool>(false);
    command.add_flag("--json", *json, "Print JSON");
    return [json] { return devices(*json); };
}

}  // namespace heliodon::cli
