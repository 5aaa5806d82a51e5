#include "app/cli/bench_scene.h"

#include <cmath>
#include <string>
#include <utility>

#include "scene/procedural.h"

namespace heliodon::cli {
namespace {

MaterialId add_lambert(Scene& scene, const char* name, glm::vec3 color, float emission_nits = 0) {
    Material material{.name = name};
    material.model = MaterialModel::lambert;
    material.base_color = color;
    material.emission_nits = glm::vec3(emission_nits);
    return scene.add_material(std::move(material));
}

MaterialId add_polished(Scene& scene, const char* name, float metallic, float ior, float transmission) {
    Material material{.name = name};
    material.base_color = glm::vec3(1);
    material.metallic = metallic;
    material.roughness = 0.1f;
    material.ior = ior;
    material.transmission = transmission;
    return scene.add_material(std::move(material));
}

void add_walls(Scene& scene, MaterialId back) {
    const MaterialId white = add_lambert(scene, "white", {0.725f, 0.71f, 0.68f});
    const auto wall = [&](const char* name, const Quad& quad, MaterialId material) {
        scene.add_node({.name = name, .parts = {{scene.add_shape(quad, name), material}}});
    };
    const glm::vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
    wall("floor", {{-1, 0, -1}, z, x}, white);
    wall("ceiling", {{-1, 2, -1}, x, z}, white);
    wall("back", {{-1, 0, -1}, x, y}, scene.materials().find(back) ? back : white);
    wall("left", {{-1, 0, -1}, y, z}, add_lambert(scene, "red", {0.63f, 0.065f, 0.05f}));
    wall("right", {{1, 0, -1}, z, y}, add_lambert(scene, "green", {0.14f, 0.45f, 0.091f}));
}

void add_objects(Scene& scene) {
    const auto place = [&](const char* name, GeometryId geometry, MaterialId material, glm::vec3 at,
                           glm::vec3 turn_deg = {}) {
        Node node{.name = name, .parts = {{geometry, material}}};
        node.transform.translation = at;
        node.transform.rotation = rotation_from_euler_deg(turn_deg);
        scene.add_node(std::move(node));
    };
    Geometry knot{.name = "knot", .mesh = torus_knot_mesh(2, 3, 0.42f, 0.09f, 880)};
    Geometry teapot{.name = "teapot", .mesh = teapot_mesh(62)};
    for (glm::vec3& position : teapot.mesh.positions) position *= 0.35f;
    place("knot", scene.add_geometry(std::move(knot)), add_polished(scene, "mirror metal", 1, 1.5f, 0),
          {-0.45f, 0.47f, -0.4f}, {90, 90, 0});
    place("ball", scene.add_shape(Sphere{{0, 0.32f, 0}, 0.32f}, "ball"), add_polished(scene, "glass", 0, 3, 1),
          {0.5f, 0, -0.35f});
    place("crate", scene.add_shape(Box{{-0.18f, 0, -0.18f}, {0.18f, 0.36f, 0.18f}}, "crate"),
          add_polished(scene, "glazed", 0, 1.5f, 0), {-0.45f, 0, 0.45f}, {0, 20, 0});
    place("teapot", scene.add_geometry(std::move(teapot)), add_lambert(scene, "green clay", {0, 0.5f, 0}),
          {0.45f, 0, 0.5f}, {0, -20, 0});
}

void add_bulb(Scene& scene, const std::string& name, glm::vec3 at, float intensity_cd) {
    Node bulb{.name = name};
    bulb.transform.translation = at;
    bulb.light = Light{.type = LightType::point, .intensity = glm::vec3(intensity_cd)};
    scene.add_node(std::move(bulb));
}

void add_camera_and_settings(Scene& scene) {
    scene.add_camera({.name = "front", .position = {0, 1, 3.9f}, .target = {0, 1, 0}, .shutter_s = 0.125f});
    RenderSettings settings;
    settings.gi = "vct";
    scene.set_render_settings(std::move(settings));
}

/// The middle of cell `index` of `edge` along one axis of the box, −1 … 1.
float cell_middle(int index, int edge) {
    return 2 * (static_cast<float>(index) + 0.5f) / static_cast<float>(edge) - 1;
}

}  // namespace

Scene natus_scene(bool emissive) {
    Scene scene;
    add_walls(scene, emissive ? add_lambert(scene, "glowing", glm::vec3(0.2f), 60) : MaterialId{});
    add_objects(scene);
    if (!emissive) add_bulb(scene, "bulb", {0, 1.3f, 0}, 100);
    add_camera_and_settings(scene);
    return scene;
}

Scene crowded_scene(int copies, int lights) {
    Scene scene;
    add_walls(scene, {});
    const GeometryId knot = scene.add_geometry({.name = "knot", .mesh = torus_knot_mesh(2, 3, 0.9f, 0.2f, 413)});
    const MaterialId clay = add_lambert(scene, "green clay", {0, 0.5f, 0});
    const int edge = static_cast<int>(std::ceil(std::cbrt(copies)));
    for (int i = 0; i < copies; ++i) {
        Node node{.name = "knot " + std::to_string(i), .parts = {{knot, clay}}};
        node.transform.translation = {cell_middle(i % edge, edge), 1 + cell_middle(i / edge % edge, edge),
                                      cell_middle(i / (edge * edge), edge)};
        node.transform.scale = glm::vec3(0.5f / static_cast<float>(edge));
        scene.add_node(std::move(node));
    }
    const int row = static_cast<int>(std::ceil(std::sqrt(lights)));
    for (int i = 0; i < lights; ++i)
        add_bulb(scene, "bulb " + std::to_string(i), {cell_middle(i % row, row), 1.9f, cell_middle(i / row, row)},
                 100.0f / static_cast<float>(lights));
    add_camera_and_settings(scene);
    return scene;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t triangles = 0;
    scene.nodes().each([&](NodeId, const Node& node) {
        for (const Part& part : node.parts)
            if (const Geometry* geometry = scene.geometries().find(part.geometry))
                triangles += geometry->mesh.triangle_count();
    });
    return triangles;
}

}  // namespace heliodon::cli
