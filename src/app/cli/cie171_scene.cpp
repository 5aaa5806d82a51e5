#include "app/cli/cie171_scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace heliodon::cli {
namespace {

constexpr float sensor_offset_m = 1e-5f;

}  // namespace

Material reflecting(float reflectance, float emission_nits) {
    Material material;
    material.model = MaterialModel::lambert;
    material.base_color = glm::vec3(reflectance);
    material.emission_nits = glm::vec3(emission_nits);
    return material;
}
Material black() {
    return reflecting(0);
}

double clear_glass_transmittance(double cosine) {
    double sum = 0;
    for (std::size_t i = clear_glass.size(); i-- > 0;) sum = sum * cosine + clear_glass[i];
    return std::clamp(sum, 0.0, 1.0);
}
Material clear_glass_pane() {
    Material material;
    material.model = MaterialModel::thin;
    std::copy(clear_glass.begin(), clear_glass.end(), material.transmittance.begin());
    return material;
}

void add_quad(Scene& scene, const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v, const Material& material) {
    Node node;
    node.parts.push_back({scene.add_shape(Quad{glm::vec3(origin), glm::vec3(u), glm::vec3(v)}), scene.add_material(material)});
    scene.add_node(std::move(node));
}

void add_light(Scene& scene, const Light& light, const glm::dvec3& position) {
    Node node;
    node.light = light;
    node.transform.translation = glm::vec3(position);
    scene.add_node(std::move(node));
}

void add_sensor(Scene& scene, const glm::dvec3& position, const glm::dvec3& normal, std::optional<SensorGrid> grid) {
    Sensor sensor;
    sensor.name = fmt::format("{}", scene.sensors().size());
    sensor.position = glm::vec3(position);
    sensor.direction = glm::vec3(normal);
    sensor.offset_m = sensor_offset_m;
    sensor.grid = grid;
    scene.add_sensor(std::move(sensor));
}

double add_grid(Scene& scene, const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v, int count_a_side) {
    add_sensor(scene, origin, glm::normalize(glm::cross(u, v)), SensorGrid{glm::vec3(u), glm::vec3(v), glm::ivec2(count_a_side)});
    return 1.0 / (count_a_side * count_a_side);
}

void add_point(CieScene& scene, const std::string& name, const glm::dvec3& position, const glm::dvec3& normal, double exact) {
    const std::size_t number = scene.scene.sensors().size();
    add_sensor(scene.scene, position, normal);
    scene.points.push_back({name, exact, {{number, 1.0}}});
}

}  // namespace heliodon::cli
