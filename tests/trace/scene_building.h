#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "scene/scene.h"
#include "trace/path_tracer.h"

namespace heliodon::tests {

inline constexpr double pi = std::numbers::pi;

inline double luminance(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

inline Material lambert(float reflectance, float emission_nits = 0, bool two_sided = false) {
    Material material;
    material.model = MaterialModel::lambert;
    material.base_color = glm::vec3(reflectance);
    material.emission_nits = glm::vec3(emission_nits);
    material.two_sided = two_sided;
    return material;
}

inline NodeId add_shape(Scene& scene, const Shape& shape, const Material& material, const Transform& transform = {}) {
    Node node;
    node.parts.push_back({scene.add_shape(shape), scene.add_material(material)});
    node.transform = transform;
    return scene.add_node(std::move(node));
}

inline Geometry triangle_mesh(std::initializer_list<glm::vec3> positions) {
    Geometry geometry;
    for (const glm::vec3& position : positions) {
        geometry.mesh.indices.push_back(static_cast<std::uint32_t>(geometry.mesh.positions.size()));
        geometry.mesh.positions.push_back(position);
    }
    geometry.bounds = geometry.mesh.bounds();
    return geometry;
}

inline NodeId add_mesh(Scene& scene, Geometry geometry, const Material& material, const Transform& transform = {}) {
    Node node;
    node.parts.push_back({scene.add_geometry(std::move(geometry)), scene.add_material(material)});
    node.transform = transform;
    return scene.add_node(std::move(node));
}

/// `rotation` turns −Z to where the light aims.
inline NodeId add_light(Scene& scene, const Light& light, glm::vec3 position, glm::quat rotation = {1, 0, 0, 0}) {
    Node node;
    node.light = light;
    node.transform.translation = position;
    node.transform.rotation = rotation;
    return scene.add_node(std::move(node));
}

inline Light point_light(float intensity_cd, float radius_m = 0) {
    Light light;
    light.intensity = glm::vec3(intensity_cd);
    light.radius_m = radius_m;
    return light;
}

/// A rotation that turns −Z to −Y: a lamp in the ceiling aims down.
inline glm::quat aiming_down() {
    return glm::angleAxis(-static_cast<float>(pi) / 2, glm::vec3(1, 0, 0));
}

inline void add_sensor(Scene& scene, SensorType type, glm::vec3 position, glm::vec3 direction) {
    scene.add_sensor({"sensor " + std::to_string(scene.sensors().size()), type, position, direction});
}
inline void add_lux(Scene& scene, glm::vec3 position, glm::vec3 normal) {
    add_sensor(scene, SensorType::illuminance, position, normal);
}

inline Camera looking(glm::vec3 position, glm::vec3 target, float fov_deg = 40) {
    Camera camera;
    camera.position = position;
    camera.target = target;
    camera.vertical_fov_rad = glm::radians(fov_deg);
    return camera;
}

inline Sky even_sky(float nits) {
    Sky sky;
    sky.model = SkyModel::constant;
    sky.luminance_nits = glm::vec3(nits);
    return sky;
}

/// A box with a lamp, a glossy ball and a masked quad: every kind of ray.
inline Scene small_room() {
    Scene scene;
    const Material white = lambert(.7f);
    add_shape(scene, Quad{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}}, white);
    add_shape(scene, Quad{{-1, 0, -1}, {2, 0, 0}, {0, 2, 0}}, white);
    add_shape(scene, Quad{{-.3f, 1.9f, -.3f}, {.6f, 0, 0}, {0, 0, .6f}}, lambert(0, 100));
    Material glossy;
    glossy.base_color = {.9f, .6f, .3f};
    glossy.metallic = 1;
    glossy.roughness = .3f;
    add_shape(scene, Sphere{{.4f, .4f, 0}, .4f}, glossy);
    Material glass = glossy;
    glass.metallic = 0;
    glass.transmission = 1;
    add_shape(scene, Sphere{{-.5f, .3f, .3f}, .3f}, glass);
    Material veil = white;
    veil.alpha_mode = AlphaMode::blend;
    veil.opacity = .5f;
    veil.two_sided = true;
    add_shape(scene, Quad{{-1, .2f, .5f}, {2, 0, 0}, {0, 1, 0}}, veil);
    add_light(scene, point_light(20, .05f), {.8f, 1.5f, .5f});
    scene.set_sky(even_sky(3));
    return scene;
}

/// Every sensor's reading after `samples` paths each.
inline std::vector<SensorReading> measure(const Scene& scene, int samples, int max_depth = 0) {
    PathTracer tracer;
    PathOptions options;
    options.samples_per_pixel = samples;
    options.max_depth = max_depth;
    const auto updated = tracer.update(scene);
    EXPECT_TRUE(updated) << (updated ? "" : updated.error().text());
    auto readings = tracer.measure(scene, options);
    EXPECT_TRUE(readings) << (readings ? "" : readings.error().text());
    return readings ? *readings : std::vector<SensorReading>{};
}

inline Picture render(const Scene& scene, const Camera& camera, const PathOptions& options,
                      PathStatistics* statistics = nullptr) {
    PathTracer tracer;
    const auto updated = tracer.update(scene);
    EXPECT_TRUE(updated) << (updated ? "" : updated.error().text());
    auto picture = tracer.render(scene, camera, options, statistics);
    EXPECT_TRUE(picture) << (picture ? "" : picture.error().text());
    return picture ? *picture : Picture{};
}

inline glm::dvec3 mean(const Image& image) {
    glm::dvec3 sum(0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += glm::dvec3(image.rgb(x, y));
    return sum / static_cast<double>(image.width * image.height);
}

/// Notes a case for docs/validation.md: `test_trace` prints the table.
void report(const std::string& name, double expected, const SensorReading& reading);

/// Within half a percent of `expected`, and what is left is no systematic error: within the reading's own
/// 95 % half-width three times over.
inline void expect_reading(const std::string& name, double expected, const SensorReading& reading,
                           double tolerance = 0.005) {
    report(name, expected, reading);
    EXPECT_NEAR(reading.value, expected, tolerance * expected) << name;
    EXPECT_NEAR(reading.value, expected, 3 * reading.half_width_95 + 2e-4 * expected) << name;
}

}  // namespace heliodon::tests
