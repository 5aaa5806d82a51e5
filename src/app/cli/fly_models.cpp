#include "app/cli/fly_models.h"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "app/cli/bench_scene.h"

namespace heliodon::cli {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

MaterialId add_matte(Scene& scene, const char* name, glm::vec3 color, bool two_sided = false) {
    Material material{.name = name};
    material.base_color = color;
    material.metallic = 0;
    material.two_sided = two_sided;
    return scene.add_material(std::move(material));
}

void place(Scene& scene, GeometryId geometry, MaterialId material, glm::vec3 at, glm::vec3 scale = glm::vec3(1)) {
    Node node{.parts = {{geometry, material}}};
    node.transform.translation = at;
    node.transform.scale = scale;
    scene.add_node(std::move(node));
}

void add_lawn(Scene& scene, float half_m) {
    const MaterialId grass = add_matte(scene, "grass", {0.08f, 0.13f, 0.04f});
    const Quad lawn{{-half_m, 0, -half_m}, {0, 0, 2 * half_m}, {2 * half_m, 0, 0}};
    place(scene, scene.add_shape(lawn, "lawn"), grass, {});
}

void append_quad(Mesh& mesh, const glm::vec3 (&corners)[4]) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[3] - corners[0]));
    for (const glm::vec3& corner : corners) {
        mesh.positions.push_back(corner);
        mesh.normals.push_back(normal);
    }
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + corner);
}

void append_box(Mesh& mesh, glm::vec3 low, glm::vec3 size) {
    constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : faces) {
        glm::vec3 corners[4];
        for (int i = 0; i < 4; ++i)
            corners[i] = low + size * glm::vec3(face[i] & 1, face[i] >> 1 & 1, face[i] >> 2 & 1);
        append_quad(mesh, corners);
    }
}

GeometryId boxes(Scene& scene, const char* name, std::initializer_list<std::pair<glm::vec3, glm::vec3>> low_and_size) {
    Geometry geometry{.name = name};
    for (const auto& [low, size] : low_and_size) append_box(geometry.mesh, low, size);
    return scene.add_geometry(std::move(geometry));
}

/// `count` leaves of 10 to 18 cm in a ball about the origin, more of them towards its surface. The same each time.
Mesh leaves_mesh(std::size_t count, float radius_m) {
    std::mt19937 random(7);  // whose sequence, unlike the distributions', is the same everywhere
    const auto even = [&] { return 2 * static_cast<float>(random()) / static_cast<float>(std::mt19937::max()) - 1; };
    const auto direction = [&] {
        for (;;)
            if (const glm::vec3 v{even(), even(), even()}; glm::dot(v, v) < 1 && glm::dot(v, v) > 0.01f)
                return glm::normalize(v);
    };
    Mesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 middle = direction() * radius_m * std::cbrt(0.5f + 0.5f * even());
        const glm::vec3 along = direction();
        const glm::vec3 u = along * (0.07f + 0.02f * even()),
                        v = 0.5f * glm::length(u) *
                            glm::normalize(
                                glm::cross(along, glm::vec3(along.y, along.z, along.x) + 0.4f * direction()));
        append_quad(mesh, {middle - u, middle - v, middle + u, middle + v});
    }
    return mesh;
}

/// |x/a|^(2/e) + |z/c|^(2/e) rounds off to |y/b| likewise: a superellipsoid (Barr 1981), closed, in rings × sectors
/// cells.
Mesh superellipsoid_mesh(glm::vec3 radii, float roundness, int rings, int sectors) {
    const auto power = [](float base, float exponent) {
        return std::copysign(std::pow(std::abs(base), exponent), base);
    };
    Mesh mesh;
    for (int ring = 0; ring <= rings; ++ring)
        for (int sector = 0; sector <= sectors; ++sector) {
            const float up = pi * (static_cast<float>(ring) / rings - 0.5f),
                        turn = 2 * pi * static_cast<float>(sector) / sectors;
            const auto at = [&](float e) {
                return glm::vec3(power(std::cos(up), e) * power(std::cos(turn), e), power(std::sin(up), e),
                                 -power(std::cos(up), e) * power(std::sin(turn), e));
            };
            mesh.positions.push_back(radii * at(roundness));
            mesh.normals.push_back(glm::normalize(at(2 - roundness) / radii));
        }
    for (int ring = 0; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector) {
            const auto a = static_cast<std::uint32_t>(ring * (sectors + 1) + sector), b = a + sectors + 1;
            for (const std::uint32_t corner : {a, a + 1, b + 1, a, b + 1, b}) mesh.indices.push_back(corner);
        }
    return mesh;
}

void add_pavilion(Scene& scene) {
    const MaterialId plaster = add_matte(scene, "plaster", glm::vec3(0.75f)),
                     wood = add_matte(scene, "wood", {0.4f, 0.25f, 0.14f});
    place(scene,
          boxes(scene, "walls",
                {{{-5, 0, -4}, {10, 3, 0.3f}},
                 {{-5, 0, -3.7f}, {0.3f, 3, 7.4f}},
                 {{-5, 0, 3.7f}, {4, 3, 0.3f}},
                 {{4.7f, 0, -3.7f}, {0.3f, 3, 3}},
                 {{-6, 3, -5}, {12, 0.3f, 11}}}),
          plaster, {});
    place(scene,
          boxes(scene, "timber",
                {{{-5, -0.1f, -4}, {10, 0.2f, 8}},
                 {{-2, -0.1f, 4}, {8, 0.15f, 3}},
                 {{4.7f, 0, 3.7f}, {0.3f, 3, 0.3f}},
                 {{5.6f, 0, 5.6f}, {0.15f, 3, 0.15f}},
                 {{1.5f, 0, 5.6f}, {0.15f, 3, 0.15f}}}),
          wood, {});
    const GeometryId table = boxes(scene, "table",
                                   {{{0, 0.7f, 0}, {1.8f, 0.04f, 0.9f}},
                                    {{0, 0, 0}, {0.06f, 0.7f, 0.06f}},
                                    {{1.74f, 0, 0}, {0.06f, 0.7f, 0.06f}},
                                    {{0, 0, 0.84f}, {0.06f, 0.7f, 0.06f}},
                                    {{1.74f, 0, 0.84f}, {0.06f, 0.7f, 0.06f}}});
    const GeometryId chair = boxes(scene, "chair",
                                   {{{0, 0.42f, 0}, {0.44f, 0.05f, 0.44f}},
                                    {{0, 0.47f, 0}, {0.44f, 0.4f, 0.04f}},
                                    {{0, 0, 0}, {0.04f, 0.42f, 0.04f}},
                                    {{0.4f, 0, 0}, {0.04f, 0.42f, 0.04f}},
                                    {{0, 0, 0.4f}, {0.04f, 0.42f, 0.04f}},
                                    {{0.4f, 0, 0.4f}, {0.04f, 0.42f, 0.04f}}});
    for (const float x : {-3.5f, 0.5f}) {
        place(scene, table, wood, {x, 0.1f, 0.5f});
        for (const float z : {-0.1f, 1.5f})
            for (const float along : {0.2f, 1.1f}) place(scene, chair, plaster, {x + along, 0.1f, z});
    }
}

}  // namespace

Scene garden_scene() {
    Scene scene;
    add_lawn(scene, 30);
    add_pavilion(scene);
    const MaterialId bark = add_matte(scene, "bark", {0.16f, 0.12f, 0.09f}),
                     green = add_matte(scene, "leaves", {0.08f, 0.14f, 0.03f}, true);
    const GeometryId trunk = boxes(scene, "trunk", {{{-0.15f, 0, -0.15f}, {0.3f, 4, 0.3f}}});
    const GeometryId crown = scene.add_geometry({.name = "crown", .mesh = leaves_mesh(6860, 2.4f)});
    for (int i = 0; i < 10; ++i) {
        const float turn = pi * (0.75f + 0.14f * static_cast<float>(i));
        const glm::vec3 at(14 * std::cos(turn), 0, -11 * std::sin(turn) - (i % 2 ? 0.0f : 3.0f));
        place(scene, trunk, bark, at);
        place(scene, crown, green, at + glm::vec3(0, 4.8f, 0));
    }
    scene.add_camera({.name = "garden", .position = {11, 1.7f, 13}, .target = {0, 2.2f, 0}});
    return scene;
}

Scene tower_scene() {
    constexpr float storey_m = 3.6f, half_m = 14;
    constexpr int storeys = 30, mullions = 32, desks_a_row = 7;
    Scene scene;
    add_lawn(scene, 150);
    Geometry frame{.name = "storey"}, desks{.name = "desks"};
    append_box(frame.mesh, {-half_m, 0, -half_m}, {2 * half_m, 0.3f, 2 * half_m});
    append_box(frame.mesh, {-4, 0.3f, -4}, {8, storey_m - 0.3f, 8});
    for (int i = 0; i < mullions; ++i) {
        const float along = half_m * (2 * static_cast<float>(i) / mullions - 1);
        const glm::vec3 size(0.12f, storey_m - 0.3f, 0.12f);
        append_box(frame.mesh, {along, 0.3f, -half_m}, size);
        append_box(frame.mesh, {along, 0.3f, half_m - 0.12f}, size);
        append_box(frame.mesh, {-half_m, 0.3f, along}, size);
        append_box(frame.mesh, {half_m - 0.12f, 0.3f, along}, size);
    }
    for (int i = 0; i < 4 * desks_a_row; ++i) {  // each a top, two sides, a screen, a seat and its back
        const int row = i / desks_a_row;
        const glm::vec3 at(3.6f * static_cast<float>(i % desks_a_row) - 12.5f, 0.3f,
                           (row < 2 ? -12.0f : 6.0f) + 3.2f * static_cast<float>(row % 2));
        for (const auto& [low, size] : {std::pair(glm::vec3(0, 0.7f, 0), glm::vec3(1.6f, 0.04f, 0.8f)),
                                        {{0, 0, 0}, {0.04f, 0.7f, 0.8f}},
                                        {{1.56f, 0, 0}, {0.04f, 0.7f, 0.8f}},
                                        {{0.5f, 0.8f, 0.2f}, {0.6f, 0.4f, 0.03f}},
                                        {{0.55f, 0.42f, 1}, {0.5f, 0.06f, 0.5f}},
                                        {{0.55f, 0.5f, 1.46f}, {0.5f, 0.5f, 0.04f}}})
            append_box(desks.mesh, at + low, size);
    }
    const GeometryId frame_id = scene.add_geometry(std::move(frame)), desks_id = scene.add_geometry(std::move(desks));
    const MaterialId concrete = add_matte(scene, "concrete", glm::vec3(0.45f)),
                     wood = add_matte(scene, "wood", {0.4f, 0.25f, 0.14f});
    for (int i = 0; i < storeys; ++i) {
        place(scene, frame_id, concrete, {0, storey_m * static_cast<float>(i), 0});
        place(scene, desks_id, wood, {0, storey_m * static_cast<float>(i), 0});
    }
    place(scene, boxes(scene, "roof", {{{-half_m, 0, -half_m}, {2 * half_m, 0.4f, 2 * half_m}}}), concrete,
          {0, storey_m * storeys, 0});
    scene.add_camera(
        {.name = "street", .position = {70, 12, 95}, .target = {0, 50, 0}, .vertical_fov_rad = glm::radians(60.0f)});
    return scene;
}

Scene car_scene() {
    Scene scene;
    add_lawn(scene, 20);
    const auto part = [&](const char* name, glm::vec3 radii, float roundness, int rings, int sectors) {
        return scene.add_geometry({.name = name, .mesh = superellipsoid_mesh(radii, roundness, rings, sectors)});
    };
    Material paint{.name = "paint"};
    paint.base_color = {0.35f, 0.02f, 0.02f};
    paint.metallic = 0;
    paint.roughness = 0.3f;
    const MaterialId paint_id = scene.add_material(std::move(paint)),
                     rubber = add_matte(scene, "rubber", glm::vec3(0.03f));
    place(scene, part("body", {2.2f, 0.36f, 0.88f}, 0.4f, 220, 300), paint_id, {0, 0.66f, 0});
    place(scene, part("cabin", {1.15f, 0.42f, 0.74f}, 0.55f, 200, 200), paint_id, {-0.2f, 1.1f, 0});
    const GeometryId wheel = part("wheel", {0.33f, 0.33f, 0.11f}, 0.6f, 90, 140);
    for (const float x : {-1.35f, 1.35f})
        for (const float z : {-0.8f, 0.8f}) place(scene, wheel, rubber, {x, 0.33f, z});
    scene.add_camera({.name = "three-quarter", .position = {4.6f, 1.7f, 4.4f}, .target = {0, 0.7f, 0}});
    return scene;
}

}  // namespace heliodon::cli
