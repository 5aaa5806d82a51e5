#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cmath>
#include <numbers>

#include "import/gltf.h"

namespace heliodon::import::gltf {
namespace {

float number(const Document& document, const Json& object, const char* key, float fallback, const std::string& at) {
    if (!object.contains(key)) return fallback;
    if (!object[key].is_number())
        document.refuse(fmt::format("{}.{}", at, key), "expected a number, found " + object[key].dump());
    const float value = object[key].get<float>();
    if (!(value >= 0 && std::isfinite(value)))
        document.refuse(fmt::format("{}.{}", at, key), "expected a number from 0 on, found " + object[key].dump());
    return value;
}

glm::vec3 color(const Document& document, const Json& light, const std::string& at) {
    if (!light.contains("color")) return glm::vec3(1);
    const Json& list = light["color"];
    if (!list.is_array() || list.size() != 3 || !list[0].is_number() || !list[1].is_number() || !list[2].is_number())
        document.refuse(at + ".color", "expected 3 numbers, found " + list.dump());
    const glm::vec3 rgb(list[0].get<float>(), list[1].get<float>(), list[2].get<float>());
    if (!(rgb.x >= 0 && rgb.y >= 0 && rgb.z >= 0 && std::isfinite(rgb.x + rgb.y + rgb.z)))
        document.refuse(at + ".color", "expected numbers from 0 on, found " + list.dump());
    return rgb;
}

Light read_light(const Document& document, const Json& json, const std::string& at) {
    if (!json.is_object()) document.refuse(at, "expected an object");
    Light light;
    light.intensity = number(document, json, "intensity", 1.0f, at) * color(document, json, at);
    light.range_m = number(document, json, "range", 0.0f, at);
    const std::string type = json.contains("type") && json["type"].is_string() ? json["type"].get<std::string>() : "";
    if (type == "point")
        light.type = LightType::point;
    else if (type == "directional")
        light.type = LightType::directional;
    else if (type == "spot") {
        light.type = LightType::spot;
        const Json spot = json.value("spot", Json::object());
        light.inner_rad = number(document, spot, "innerConeAngle", 0.0f, at + ".spot");
        light.outer_rad = number(document, spot, "outerConeAngle", std::numbers::pi_v<float> / 4, at + ".spot");
        const bool good = light.inner_rad >= 0 && light.inner_rad < light.outer_rad &&
                          light.outer_rad <= std::numbers::pi_v<float> / 2 + 1e-6f;
        if (!good)
            document.refuse(at + ".spot", fmt::format("expected 0 ≤ inner < outer ≤ π/2, found {} and {}",
                                                      light.inner_rad, light.outer_rad));
    } else {
        document.refuse(at + ".type", "expected point, spot or directional, found \"" + type + "\"");
    }
    return light;
}

/// How far in front of a camera it orbits: the depth of what it looks at, or 1 m where that lies behind it.
float orbit_distance(const Scene& scene, glm::vec3 position, glm::vec3 forward) {
    const Bounds bounds = scene.bounds();
    const float depth = bounds.empty() ? 0.0f : glm::dot(bounds.center() - position, forward);
    return depth > 0 ? depth : 1.0f;
}

}  // namespace

std::vector<Light> read_lights(const Document& document) {
    std::vector<Light> lights;
    const Json* punctual = extension(document.json(), "KHR_lights_punctual");
    if (!punctual) return lights;
    const std::string at = "$.extensions.KHR_lights_punctual.lights";
    if (!punctual->contains("lights") || !(*punctual)["lights"].is_array()) document.refuse(at, "expected a list");
    for (std::size_t i = 0; i < (*punctual)["lights"].size(); ++i)
        lights.push_back(read_light(document, (*punctual)["lights"][i], fmt::format("{}[{}]", at, i)));
    return lights;
}

std::vector<std::optional<Camera>> read_cameras(const Document& document, const tinygltf::Model& model,
                                                Warnings& warnings) {
    std::vector<std::optional<Camera>> cameras(model.cameras.size());
    bool orthographic = false;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const tinygltf::Camera& source = model.cameras[i];
        if (source.type != "perspective") {
            orthographic = true;
            continue;
        }
        if (!(source.perspective.yfov > 0 && source.perspective.yfov < std::numbers::pi))
            document.refuse(fmt::format("$.cameras[{}].perspective.yfov", i),
                            fmt::format("expected an angle between 0 and π, found {}", source.perspective.yfov));
        cameras[i].emplace();
        cameras[i]->name = source.name.empty() ? fmt::format("camera {}", i) : source.name;
        cameras[i]->vertical_fov_rad = float(source.perspective.yfov);
    }
    if (orthographic) warnings.push_back({document.path().string(), "ignores orthographic cameras"});
    return cameras;
}

void add_cameras(const std::vector<std::optional<Camera>>& cameras, const tinygltf::Model& model,
                 const std::vector<NodeId>& nodes, Scene& scene) {
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const int index = model.nodes[i].camera;
        if (index < 0 || !nodes[i] || !cameras[std::size_t(index)]) continue;
        const glm::mat4 world = scene.world_matrix(nodes[i]);
        const glm::vec3 forward = -glm::vec3(world[2]), up(world[1]);
        if (!(glm::length(glm::cross(forward, up)) > 0)) continue;  // scaled to nothing: it looks nowhere
        Camera camera = *cameras[std::size_t(index)];
        if (!model.nodes[i].name.empty()) camera.name = model.nodes[i].name;
        camera.position = glm::vec3(world[3]);
        camera.target =
            camera.position + glm::normalize(forward) * orbit_distance(scene, camera.position, glm::normalize(forward));
        camera.up = glm::normalize(up);
        scene.add_camera(std::move(camera));
    }
}

}  // namespace heliodon::import::gltf
