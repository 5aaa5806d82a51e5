// CIE 171:2006, tests 5.2 to 5.8: lamps, lit patches, glass and interreflection. The report is the International
// Commission on Illumination's, "Test Cases to Assess the Accuracy of Lighting Computer Programs"; every answer here is
// its formula, evaluated.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "app/cli/cie171_exact.h"
#include "app/cli/cie171_scene.h"

namespace heliodon::cli {
namespace {

constexpr double pi = std::numbers::pi;

CieScene scene_of(const char* test, std::string variant, const char* unit) {
    CieScene result;
    result.test = test;
    result.variant = std::move(variant);
    result.unit = unit;
    return result;
}

Light point_light(double intensity_cd) {
    Light light;
    light.intensity = glm::vec3(static_cast<float>(intensity_cd));
    return light;
}

/// Heights of the six points A to F of a wall, and distances from it of the points G on of a floor or ceiling.
double wall_height(int i) { return 2.75 - 0.5 * i; }
double floor_distance(int i) { return 0.25 + 0.5 * i; }

CieScene point_source() {
    CieScene result = scene_of("5.2", "", "lx");
    result.max_depth = 1;
    Light light = point_light(1000);
    light.lambertian = true;  // along −Z
    Node node;
    node.light = light;
    node.transform.translation = room(0, 0, 3);
    node.transform.rotation = rotation_from_euler_deg({-90, 0, 0});
    result.scene.add_node(std::move(node));
    const std::pair<double, double> places[] = {{0, 0},  {.5, 0},   {1, 0}, {1.5, 0},  {.5, .5},
                                                {1, .5}, {1.5, .5}, {1, 1}, {1.5, 1}, {1.5, 1.5}};
    for (const auto& [x, y] : places) {
        const double squared = 9 + x * x + y * y;
        add_point(result, fmt::format("({:g}, {:g})", x, y), room(x, y, 0), room(0, 0, 1), 1000 * 9 / (squared * squared));
    }
    return result;
}

CieScene area_source() {
    CieScene result = scene_of("5.3", "", "lx");
    constexpr float nits = 1000;
    const Aperture lamp{room(1.5, 1.5, 3), room(1, 0, 0), room(0, 1, 0)};
    add_quad(result.scene, lamp.corner, lamp.u, lamp.v, reflecting(0, nits));
    const auto add = [&](const std::string& name, const glm::dvec3& position, const glm::dvec3& normal) {
        add_point(result, name, position, normal, illuminance_through(lamp, position, normal, [](const auto&) { return nits; }));
    };
    for (int i = 0; i < 6; ++i) add(std::string(1, "ABCDEF"[i]), room(2, 0, wall_height(i)), room(0, 1, 0));
    for (int i = 0; i < 4; ++i) add(std::string(1, "GHIJ"[i]), room(2, floor_distance(i), 0), room(0, 0, 1));
    return result;
}

CieScene flux_of_a_lamp() {
    CieScene result = scene_of("5.4", "", "lm");
    result.max_depth = 1;
    result.samples = 32;  // without noise
    constexpr double flux = 10000;
    constexpr int cells = 32;  // a side: the midpoint rule is right to 3·10⁻⁴ here
    add_light(result.scene, point_light(flux / (4 * pi)), room(2, 2, 1.5));
    CiePoint all{"on all walls", flux, {}};
    const glm::dvec3 x = room(4, 0, 0), y = room(0, 4, 0), z = room(0, 0, 3);
    const struct {
        glm::dvec3 origin, u, v;
    } walls[] = {{{}, y, x}, {z, x, y}, {{}, x, z}, {y, z, x}, {{}, z, y}, {x, y, z}};
    for (const auto& wall : walls) {
        const double area = glm::length(glm::cross(wall.u, wall.v));
        const double weight = add_grid(result.scene, wall.origin, wall.u, wall.v, cells) * area;
        for (int i = 0; i < cells * cells; ++i) all.sensors.emplace_back(all.sensors.size(), weight);
    }
    result.points.push_back(std::move(all));
    return result;
}

CieScene glass_at(double angle_deg) {
    CieScene result = scene_of("5.5", fmt::format("{:g}°", angle_deg), "%");
    const double angle = angle_deg * pi / 180;
    add_quad(result.scene, room(-50, -50, 1), room(100, 0, 0), room(0, 100, 0), clear_glass_pane());
    Light beam;
    beam.type = LightType::directional;
    constexpr double lux = 1000;
    beam.intensity = glm::vec3(lux);
    beam.direction = {std::sin(angle), -std::cos(angle), 0};
    add_light(result.scene, beam, {});
    result.scale = 100 / (lux * std::cos(angle));
    add_point(result, "transmittance", room(0, 0, 0), room(0, 0, 1), 100 * clear_glass_transmittance(std::cos(angle)));
    return result;
}

CieScene lit_floor() {
    CieScene result = scene_of("5.6", "", "% of E_hz ρ");
    constexpr float reflectance = 0.3f, lux = 1000;
    const Aperture patch{room(0, 0, 0), room(4, 0, 0), room(0, 4, 0)};
    add_quad(result.scene, patch.corner, patch.v, patch.u, reflecting(reflectance));
    Light beam;
    beam.type = LightType::directional;
    beam.intensity = glm::vec3(lux);
    beam.direction = {0, -1, 0};
    add_light(result.scene, beam, {});
    result.scale = 100 / (lux * reflectance);
    const auto add = [&](const std::string& name, const glm::dvec3& position, const glm::dvec3& normal) {
        add_point(result, name, position, normal,
                  100 * illuminance_through(patch, position, normal, [](const auto&) { return 1 / pi; }));
    };
    for (int i = 0; i < 5; ++i) add(fmt::format("wall, z {:g}", wall_height(i)), room(2, 0, wall_height(i)), room(0, 1, 0));
    for (int i = 0; i < 4; ++i)
        add(fmt::format("ceiling, y {:g}", floor_distance(i)), room(2, floor_distance(i), 3), room(0, 0, -1));
    return result;
}

CieScene lit_wall_past_an_obstacle() {
    CieScene result = scene_of("5.7", "", "% of E_v ρ");
    // The wall evenly lit: as bright as if it shone by itself.
    add_quad(result.scene, room(0, 4, 0), room(0, 0, 3), room(4, 0, 0), reflecting(0, static_cast<float>(1 / pi)));
    Node obstacle;
    const glm::vec3 low(room(0, 2.5, 0)), high(room(4, 2.7, 1));
    obstacle.parts.push_back({result.scene.add_shape(Box{low, high}), result.scene.add_material(black())});
    result.scene.add_node(std::move(obstacle));
    result.scale = 100;
    result.floor = 0.05;
    const auto add = [&](const std::string& name, double y, double z, const glm::dvec3& normal) {
        // The wall shows above the higher of the two edges of the obstacle's top.
        double hidden = 0;
        for (const double edge : {2.5, 2.7}) hidden = std::max(hidden, y < edge ? z + (1 - z) * (4 - y) / (edge - y) : 0.0);
        const Aperture seen{room(0, 4, hidden), room(4, 0, 0), room(0, 0, 3 - hidden)};
        const auto bright = [](const auto&) { return 1 / pi; };
        const bool any = hidden < 3 - 1e-9;
        add_point(result, name, room(2, y, z), normal, any ? 100 * illuminance_through(seen, room(2, y, z), normal, bright) : 0);
    };
    for (int i = 0; i < 6; ++i) add(std::string(1, "ABCDEF"[i]), 0, wall_height(i), room(0, 1, 0));
    for (int i = 0; i < 5; ++i) add(std::string(1, "GHIJK"[i]), floor_distance(i), 0, room(0, 0, 1));
    return result;
}

/// ρ Φ / (S (1 − ρ)); with ρ = 0 the mean of what the lamp sends directly, Φ/S.
CieScene cube(double reflectance) {
    CieScene result = scene_of("5.8", reflectance > 0 ? fmt::format("ρ {:g}, indirect", reflectance) : "direct", "lx");
    constexpr double flux = 10000, area = 96;
    constexpr int cells = 32;
    result.samples = 512;
    const Material material = reflecting(static_cast<float>(reflectance));
    const glm::dvec3 x = room(4, 0, 0), y = room(0, 4, 0), z = room(0, 0, 4);
    add_quad(result.scene, {}, y, x, material);
    add_quad(result.scene, z, x, y, material);
    add_quad(result.scene, {}, x, z, material);
    add_quad(result.scene, y, z, x, material);
    add_quad(result.scene, {}, z, y, material);
    add_quad(result.scene, x, y, z, material);
    add_light(result.scene, point_light(flux / (4 * pi)), room(2, 2, 2));
    const double weight = add_grid(result.scene, {}, y, x, cells);
    CiePoint mean{"mean of a face", reflectance > 0 ? reflectance * flux / (area * (1 - reflectance)) : flux / area, {}};
    for (int i = 0; i < cells * cells; ++i) mean.sensors.emplace_back(i, weight);
    result.points.push_back(std::move(mean));
    result.indirect = reflectance > 0;
    result.max_depth = reflectance > 0 ? 0 : 1;
    // Of what a point receives ρ is indirect; the errors of many points average out.
    result.error_share = reflectance > 0 ? 0.9 * cells * reflectance : 1;
    return result;
}

}  // namespace

std::vector<std::string> cie_tests() {
    return {"5.2", "5.3", "5.4", "5.5", "5.6", "5.7", "5.8", "5.9", "5.10", "5.11", "5.12", "5.13", "5.14"};
}

std::vector<CieScene> cie_scenes(const std::string& test) {
    std::vector<CieScene> scenes;
    if (test == "5.2") scenes.push_back(point_source());
    if (test == "5.3") scenes.push_back(area_source());
    if (test == "5.4") scenes.push_back(flux_of_a_lamp());
    if (test == "5.5")
        for (const double angle : {0, 10, 20, 30, 40, 50, 60, 70, 80}) scenes.push_back(glass_at(angle));
    if (test == "5.6") scenes.push_back(lit_floor());
    if (test == "5.7") scenes.push_back(lit_wall_past_an_obstacle());
    if (test == "5.8")
        for (const double reflectance : {0.0, .2, .5, .8, .9, .95}) scenes.push_back(cube(reflectance));
    return scenes.empty() ? cie_daylight_scenes(test) : std::move(scenes);
}

}  // namespace heliodon::cli
