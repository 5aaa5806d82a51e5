#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cli/commands.h"
#include "app/cli/outputs.h"
#include "app/cli/scene_argument.h"
#include "app/cli/terminal.h"

namespace heliodon::cli {
namespace {

using nlohmann::ordered_json;

struct InfoOptions {
    SceneArgument scene;
    bool json = false;
};

ordered_json vector_json(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

ordered_json luminaire_json(ordered_json entry, const Light& light) {
    const Luminaire& luminaire = *light.luminaire;
    entry["type"] = "ies";
    entry["luminaire"] = luminaire.name;
    entry["intensity_cd"] = vector_json(light.intensity);
    entry["flux_lm"] = flux_lm(light);
    entry["measured_flux_lm"] = luminaire.flux_lm;
    entry["measured_peak_cd"] = luminaire.peak_cd;
    entry["planes"] = luminaire.web.azimuth_rad.size();
    entry["polar_angles"] = luminaire.web.polar_rad.size();
    entry["opening"] = describe(luminaire.opening);
    entry["opening_m"] = vector_json(luminaire.opening.size_m);
    return entry;
}

ordered_json light_json(const Node& node) {
    const Light& light = *node.light;
    ordered_json entry = {{"name", node.name}};
    if (light.type == LightType::directional) {
        entry["type"] = "directional";
        entry["illuminance_lux"] = vector_json(light.intensity);
        return entry;
    }
    if (light.luminaire) return luminaire_json(std::move(entry), light);
    entry["type"] = light.type == LightType::spot ? "spot" : light.lambertian ? "lambertian" : "point";
    entry["intensity_cd"] = vector_json(light.intensity);
    entry["flux_lm"] = flux_lm(light);
    return entry;
}

/// Everything that the command says, in the order it says it.
ordered_json describe(const Scene& scene, const Warnings& warnings) {
    std::size_t triangles = 0, parts = 0, geometry_bytes = 0, texture_bytes = 0;
    scene.geometries().each([&](GeometryId, const Geometry& geometry) { geometry_bytes += geometry.mesh.bytes(); });
    scene.textures().each([&](TextureId, const Texture& texture) { texture_bytes += texture.bytes(); });
    ordered_json lights = ordered_json::array(), cameras = ordered_json::array(), sensors = ordered_json::array();
    scene.nodes().each([&](NodeId, const Node& node) {
        parts += node.parts.size();
        for (const Part& part : node.parts)
            if (const Geometry* geometry = scene.geometries().find(part.geometry))
                triangles += geometry->mesh.triangle_count();
        if (node.light) lights.push_back(light_json(node));
    });
    scene.cameras().each([&](CameraId, const Camera& camera) {
        cameras.push_back({{"name", camera.name}, {"ev100", camera.ev100()}});
    });
    scene.sensors().each([&](SensorId, const Sensor& sensor) { sensors.push_back(sensor.name); });

    ordered_json report = {
        {"nodes", scene.nodes().size()},           {"drawn_parts", parts},
        {"meshes", scene.geometries().size()},     {"triangles", triangles},
        {"materials", scene.materials().size()},   {"textures", scene.textures().size()},
        {"animations", scene.animations().size()}, {"duration_s", scene.animation_duration_s()},
    };
    const Bounds bounds = scene.bounds();
    report["bounds_m"] = bounds.empty()
                             ? ordered_json()
                             : ordered_json{{"min", vector_json(bounds.min)}, {"max", vector_json(bounds.max)}};
    report["geometry_bytes"] = geometry_bytes;
    report["texture_bytes"] = texture_bytes;
    report["peak_rss_bytes"] = peak_rss_bytes();
    report["cameras"] = std::move(cameras);
    report["lights"] = std::move(lights);
    report["sensors"] = std::move(sensors);
    report["warnings"] = ordered_json::array();
    for (const Error& warning : warnings) report["warnings"].push_back(warning.text());
    return report;
}

std::string vector_text(const ordered_json& v) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
}

std::string mebibytes(const ordered_json& bytes) {
    return fmt::format("{:.1f} MiB", bytes.get<double>() / (1024.0 * 1024.0));
}

std::string luminaire_text(const ordered_json& light) {
    std::string text =
        fmt::format("{:.6g} lm, peak {} cd, measured {:.6g} lm and {:.6g} cd in {} planes of {} angles, {}",
                    light["flux_lm"].get<double>(), vector_text(light["intensity_cd"]), light["measured_flux_lm"].get<double>(),
                    light["measured_peak_cd"].get<double>(), light["planes"].get<std::size_t>(),
                    light["polar_angles"].get<std::size_t>(), light["opening"].get<std::string>());
    if (light["opening"] != "point") text += " of " + vector_text(light["opening_m"]) + " m";
    return text + "\n";
}

std::string as_text(const ordered_json& report) {
    std::string text;
    for (const char* key : {"nodes", "drawn_parts", "meshes", "triangles", "materials", "textures", "animations"})
        text += fmt::format("{:<16}{}\n", key, report[key].get<std::size_t>());
    const auto& bounds = report["bounds_m"];
    text += fmt::format(
        "{:<16}{}\n", "bounds",
        bounds.is_null() ? "nothing visible" : vector_text(bounds["min"]) + " to " + vector_text(bounds["max"]) + " m");
    text += fmt::format("{:<16}{} geometry, {} textures, {} peak\n", "memory", mebibytes(report["geometry_bytes"]),
                        mebibytes(report["texture_bytes"]), mebibytes(report["peak_rss_bytes"]));
    for (const auto& camera : report["cameras"])
        text += fmt::format("{:<16}{}, EV100 {:.2f}\n", "camera", camera["name"].get<std::string>(),
                            camera["ev100"].get<double>());
    for (const auto& light : report["lights"]) {
        text +=
            fmt::format("{:<16}{}, {}, ", "light", light["name"].get<std::string>(), light["type"].get<std::string>());
        if (light.contains("luminaire")) {
            text += luminaire_text(light);
            continue;
        }
        text += light.contains("flux_lm") ? fmt::format("{:.4g} lm, {} cd\n", light["flux_lm"].get<double>(),
                                                        vector_text(light["intensity_cd"]))
                                          : fmt::format("{} lux\n", vector_text(light["illuminance_lux"]));
    }
    for (const auto& sensor : report["sensors"]) text += fmt::format("{:<16}{}\n", "sensor", sensor.get<std::string>());
    for (const auto& warning : report["warnings"])
        text += fmt::format("{:<16}{}\n", "approximated", warning.get<std::string>());
    return text;
}

Result<void> info(const InfoOptions& options) {
    Warnings warnings;
    auto scene = load(options.scene, warnings);
    if (!scene) return tl::unexpected(scene.error());
    const ordered_json report = describe(*scene, warnings);
    return print(options.json ? report.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n"
                              : as_text(report));
}

}  // namespace

Action declare_info(CLI::App& command) {
    auto options = std::make_shared<InfoOptions>();
    add_scene_argument(command, options->scene);
    command.add_flag("--json", options->json, "Print JSON");
    return [options] { return info(*options); };
}

}  // namespace heliodon::cli
