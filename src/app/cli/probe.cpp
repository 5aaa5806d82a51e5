#include "app/cli/probe.h"

#include <fmt/format.h>

#include <cmath>

#include "core/units.h"

namespace heliodon::cli {
namespace {

/// A camera that sees nothing but the middle of a pixel.
Camera aimed_at(const Camera& camera, ProbedPixel pixel, int width, int height) {
    constexpr float narrow_rad = 1e-4f;
    const float half_height = std::tan(0.5f * camera.vertical_fov_rad);
    const glm::vec2 place = (glm::vec2(pixel.x, pixel.y) + 0.5f) / glm::vec2(width, height) * 2.0f - 1.0f;
    const glm::vec3 in_view(place.x * half_height * float(width) / float(height), -place.y * half_height, -1);
    const glm::mat3 view_to_world = glm::transpose(glm::mat3(camera.world_to_view()));
    Camera aimed = camera;
    aimed.target = camera.position + view_to_world * in_view;
    aimed.up = view_to_world * glm::vec3(0, 1, 0);
    aimed.vertical_fov_rad = narrow_rad;
    return aimed;
}

const Image* layer(const Picture& picture, std::string_view name) {
    for (const Layer& layer : picture.layers)
        if (layer.name == name) return &layer.image;
    return nullptr;
}

std::string name_of(ProbedPixel pixel) {
    return fmt::format("{},{}", pixel.x, pixel.y);
}

void replace_sensors(Scene& scene, const std::vector<ProbeReading>& readings) {
    std::vector<SensorId> old;
    scene.sensors().each([&](SensorId id, const Sensor&) { old.push_back(id); });
    for (const SensorId id : old) scene.remove(id);
    for (const ProbeReading& reading : readings) {
        if (!reading.position) continue;
        Sensor sensor;
        sensor.name = name_of(reading.pixel);
        sensor.type = SensorType::illuminance;
        sensor.position = *reading.position;
        sensor.direction = *reading.normal;
        scene.add_sensor(std::move(sensor));
    }
}

}  // namespace

Result<std::vector<ProbeReading>> probe(Scene& scene, const Camera& camera, const Picture& picture,
                                        const std::vector<ProbedPixel>& pixels, const ProbeEngine& engine) {
    std::vector<ProbeReading> readings;
    bool any_surface = false;
    for (const ProbedPixel pixel : pixels) {
        ProbeReading reading;
        reading.pixel = pixel;
        reading.luminance_rgb = picture.image.rgb(pixel.x, pixel.y);
        auto layers = engine.layers(aimed_at(camera, pixel, picture.image.width, picture.image.height), 1, 1);
        if (!layers) return tl::unexpected(layers.error());
        const Image *position = layer(*layers, "position"), *normal = layer(*layers, "normal");
        if (position && normal && glm::length(normal->rgb(0, 0)) > 0) {
            reading.position = position->rgb(0, 0);
            reading.normal = glm::normalize(normal->rgb(0, 0));
            any_surface = true;
        }
        readings.push_back(std::move(reading));
    }
    if (!any_surface) return readings;
    replace_sensors(scene, readings);
    auto measured = engine.measure(scene);
    if (!measured) return tl::unexpected(measured.error());
    // By name: sensors do not stand in the order in which they were added.
    for (ProbeReading& reading : readings)
        for (const SensorReading& sensor : *measured)
            if (sensor.name == name_of(reading.pixel)) reading.illuminance = sensor;
    return readings;
}

std::string as_text(const std::vector<ProbeReading>& readings) {
    std::string text;
    for (const ProbeReading& r : readings) {
        text += fmt::format("{}pixel {},{}: {:.6g} cd/m2", text.empty() ? "" : "\n", r.pixel.x, r.pixel.y,
                            units::luminance(r.luminance_rgb));
        if (r.position)
            text += fmt::format(", {:.6g} lux (95 %: +-{:.2g}) at ({:.4g}, {:.4g}, {:.4g})", r.illuminance.value,
                                r.illuminance.half_width_95, r.position->x, r.position->y, r.position->z);
        else
            text += ", no surface";
    }
    return text;
}

nlohmann::json as_json(const std::vector<ProbeReading>& readings) {
    nlohmann::json probes = nlohmann::json::array();
    for (const ProbeReading& r : readings) {
        nlohmann::json probe{{"pixel", {r.pixel.x, r.pixel.y}},
                             {"luminance_nits", units::luminance(r.luminance_rgb)},
                             {"rgb", {r.luminance_rgb.x, r.luminance_rgb.y, r.luminance_rgb.z}}};
        if (r.position) {
            probe["position"] = {r.position->x, r.position->y, r.position->z};
            probe["normal"] = {r.normal->x, r.normal->y, r.normal->z};
            probe["illuminance_lux"] = r.illuminance.value;
            probe["half_width_95"] = r.illuminance.half_width_95;
        }
        probes.push_back(std::move(probe));
    }
    return probes;
}

}  // namespace heliodon::cli
