#include <cstdio>
#include <cstdlib>
#include <ostream>
#include <utility>
#include <vector>

#include "engine_parity.h"

namespace heliodon::tests {
namespace {

constexpr int columns = 5, rows = 3, cell = 32;

struct NamedMaterial {
    const char* name;
    Material material;
};

Material of_model(MaterialModel model, glm::vec3 color, float roughness) {
    Material material;
    material.model = model;
    material.base_color = color;
    material.roughness = roughness;
    return material;
}
Material changed(Material material, void (*change)(Material&)) {
    change(material);
    return material;
}

/// Every model and every layer, a sphere each.
std::vector<NamedMaterial> materials() {
    using enum MaterialModel;
    const glm::vec3 clay(0.7f, 0.5f, 0.4f);
    return {
        {"lambert", of_model(lambert, clay, 1)},
        {"standard dielectric", of_model(standard, clay, 0.4f)},
        {"standard metal", changed(of_model(standard, clay, 0.3f), [](Material& m) { m.metallic = 1; })},
        {"clear coat", changed(of_model(standard, clay, 0.8f), [](Material& m) { m.clearcoat = 1, m.clearcoat_roughness = 0.2f; })},
        {"rough glass", changed(of_model(standard, glm::vec3(1), 0.4f), [](Material& m) { m.transmission = 1; })},
        {"anisotropic metal", changed(of_model(standard, clay, 0.3f),
                                      [](Material& m) { m.metallic = 1, m.anisotropy = 0.7f, m.anisotropy_rotation_rad = 0.6f; })},
        {"sheen", changed(of_model(standard, clay, 0.9f), [](Material& m) { m.sheen_color = glm::vec3(0.9f), m.sheen_roughness = 0.4f; })},
        {"iridescence", changed(of_model(standard, clay, 0.3f), [](Material& m) { m.metallic = 0.5f, m.iridescence = 1; })},
        {"thin-walled glass", changed(of_model(standard, glm::vec3(1), 0.4f), [](Material& m) { m.transmission = 1, m.thin_walled = true; })},
        {"disney", changed(of_model(disney, clay, 0.4f),
                           [](Material& m) { m.specular = 0.5f, m.subsurface = 0.5f, m.sheen = 1, m.clearcoat = 1, m.clearcoat_gloss = 0.3f; })},
        {"disney metal", changed(of_model(disney, clay, 0.4f), [](Material& m) { m.metallic = 1, m.anisotropy = 0.8f; })},
        {"rough diffuse", of_model(oren_nayar, clay, 0.9f)},
        {"Oren-Nayar, sigma 30°", changed(of_model(oren_nayar, clay, 1), [](Material& m) { m.sigma_rad = glm::radians(30.0f); })},
        {"gold", changed(of_model(conductor, clay, 0.3f), [](Material& m) { m.metal = NamedMetal::gold; })},
        {"dielectric", of_model(dielectric, clay, 0.3f)},
    };
}

Image cut(const Image& image, int column, int row) {
    Image result(cell, cell, 3);
    for (int y = 0; y < cell; ++y)
        for (int x = 0; x < cell; ++x)
            for (int c = 0; c < 3; ++c) result.at(x, y, c) = image.at(column * cell + x, row * cell + y, c);
    return result;
}

struct NamedLight {
    const char* name;
    Light light;
    int samples = 64;  ///< of an extended light each takes one point
    friend void PrintTo(const NamedLight& named, std::ostream* out) { *out << named.name; }
};

class MaterialParity : public EngineParity, public ::testing::WithParamInterface<NamedLight> {
protected:
    static Scene scene_under(const Light& light) {
        Scene scene;
        const Mesh ball = tessellate(Sphere{{0, 0, 0}, 0.42f}, 96);
        const auto all = materials();
        for (std::size_t i = 0; i < all.size(); ++i) {
            Geometry geometry;
            geometry.mesh = ball;
            geometry.bounds = ball.bounds();
            Node node;
            node.transform.translation = {static_cast<float>(i % columns) - 0.5f * (columns - 1),
                                          0.5f * (rows - 1) - static_cast<float>(i / columns), 0};
            node.parts.push_back({scene.add_geometry(std::move(geometry)), scene.add_material(all[i].material)});
            scene.add_node(std::move(node));
        }
        Node lamp;
        lamp.transform.translation = {-1.5f, 2, 5};
        lamp.transform.rotation = rotation_from_euler_deg({-20, -15, 0});
        lamp.light = light;
        scene.add_node(std::move(lamp));
        Camera camera;
        camera.position = {0, 0, 20};
        camera.target = {0, 0, 0};
        camera.vertical_fov_rad = 2 * std::atan(0.5f * rows / 20);
        camera.ev100_override = 1.0f;
        scene.add_camera(camera);
        return scene;
    }
};

TEST_P(MaterialParity, DirectLightIsThePathTracersOnEveryMaterial) {
    const Pictures pictures = render_both(scene_under(GetParam().light), {.size = columns * cell, .realtime_samples = GetParam().samples, .path_samples = GetParam().samples, .height = rows * cell});
    const auto all = materials();
    ASSERT_EQ(all.size(), static_cast<std::size_t>(columns * rows));
    const bool table = std::getenv("HELIODON_ACCURACY_TABLE");
    for (int i = 0; i < columns * rows; ++i) {
        const Image path = cut(pictures.path.image, i % columns, i / columns), realtime = cut(pictures.realtime.image, i % columns, i / columns);
        double seen = 0;
        for (const float value : path.pixels) seen += value;
        EXPECT_GT(seen, 0) << all[i].name << " shows nothing";
        const auto metrics = compare(path, realtime, pictures.path.ev100);
        ASSERT_TRUE(metrics) << metrics.error().text();
        EXPECT_LE(metrics->flip, 0.05) << all[i].name;
        if (table) std::printf("%s | %s | %.4f | %.1e\n", GetParam().name, all[i].name, metrics->flip, metrics->relmse);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Under, MaterialParity,
    ::testing::Values(NamedLight{"point", {.type = LightType::point, .intensity = glm::vec3(90)}},
                      NamedLight{"spot", {.type = LightType::spot, .intensity = glm::vec3(90), .inner_rad = 0.3f, .outer_rad = 0.7f}},
                      NamedLight{"directional", {.type = LightType::directional, .intensity = glm::vec3(3), .direction = {0.3f, -0.4f, -1}}},
                      NamedLight{"lambertian", {.type = LightType::point, .intensity = glm::vec3(90), .lambertian = true}},
                      NamedLight{"sphere", {.type = LightType::point, .intensity = glm::vec3(90), .radius_m = 0.5f}, 256}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace heliodon::tests
