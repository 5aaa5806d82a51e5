#include "engine_parity.h"

namespace heliodon::tests {
namespace {

/// Every scene is lit by one point light, so that the reference has noise at edges only.
class SurfaceParity : public EngineParity {
protected:
    static constexpr Effort effort{96, 32, 64};
    Scene scene;
    MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));

    void SetUp() override {
        EngineParity::SetUp();
        RenderSettings settings;
        settings.shadow_map_size = 1024;
        scene.set_render_settings(settings);
        add_floor(scene, 2, white);
        add_point_light(scene, {0.6f, 2, 1.4f}, glm::vec3(40));
        Camera camera;
        camera.position = {0, 1.4f, 3};
        camera.target = {0, 0.5f, 0};
        camera.vertical_fov_rad = 0.8f;
        camera.ev100_override = 2.0f;
        scene.add_camera(camera);
    }
    NodeId add_mesh_node(Mesh mesh, MaterialId material, const Transform& transform = {}) {
        Geometry geometry;
        geometry.mesh = std::move(mesh);
        geometry.bounds = geometry.mesh.bounds();
        Node node;
        node.transform = transform;
        node.parts.push_back({scene.add_geometry(std::move(geometry)), material});
        return scene.add_node(std::move(node));
    }
    /// Unfiltered, so that both engines read the same texels.
    TextureId add_texels(int width, int height, TextureFormat format, std::vector<std::uint8_t> bytes, bool opaque = true) {
        Texture texture;
        texture.width = width;
        texture.height = height;
        texture.format = format;
        texture.magnify = texture.minify = Filter::nearest;
        texture.mipmapped = false;
        texture.opaque = opaque;
        texture.levels = {std::move(bytes)};
        return scene.add_texture(std::move(texture));
    }
    Mesh upright_quad() { return tessellate(Quad{{-0.5f, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 8); }
};

TEST_F(SurfaceParity, AMaskedLeafsTexelsAndTheirShadowAgree) {
    Material leaf = lambert({0.3f, 0.7f, 0.2f});
    leaf.alpha_mode = AlphaMode::mask;
    leaf.two_sided = true;
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 16; ++i)
        for (const int value : {255, 200, 150, (i + i / 4) % 2 ? 255 : 20}) texels.push_back(static_cast<std::uint8_t>(value));
    leaf.base_color_texture.texture = add_texels(4, 4, TextureFormat::srgb8, texels, false);
    add_mesh_node(upright_quad(), scene.add_material(leaf), Transform{.translation = {-0.2f, 0.1f, 0}});
    expect_agreement(scene, effort, {0.001, 0.002, 0.02});
}

TEST_F(SurfaceParity, BlendedSheetsOverOneAnotherAndTheirShadowsAgree) {
    for (const float x : {-0.5f, 0.0f}) {
        Material sheet = lambert({0.8f, 0.3f + x, 0.2f - 0.8f * x});
        sheet.base_color = glm::clamp(sheet.base_color, 0.05f, 1.0f);
        sheet.alpha_mode = AlphaMode::blend;
        sheet.opacity = 0.5f;
        sheet.two_sided = true;
        add_mesh_node(upright_quad(), scene.add_material(sheet), Transform{.translation = {x, 0.1f, 0.3f + x}});
    }
    expect_agreement(scene, {96, 96, 192}, {0.03, 0.003, 0.02});
}

TEST_F(SurfaceParity, VertexColoursAgree) {
    Mesh sphere = tessellate(Sphere{{0, 0.5f, 0}, 0.5f}, 64);
    for (const glm::vec3 p : sphere.positions) sphere.colors.push_back(glm::vec4(p.x + 0.5f, p.y, p.z + 0.5f, 1));
    add_mesh_node(std::move(sphere), scene.add_material(lambert(glm::vec3(1))));
    expect_agreement(scene, effort, {0.001, 0.002, 0.02});
}

TEST_F(SurfaceParity, TwoSidedLeavesAreLitOnTheSideThatIsSeen) {
    Material leaf;
    leaf.base_color = {0.3f, 0.7f, 0.2f};
    leaf.roughness = 0.4f;
    leaf.two_sided = true;
    const MaterialId green = scene.add_material(leaf);
    int i = 0;
    for (const float turn : {-150.0f, -60.0f, 20.0f, 160.0f})
        add_mesh_node(upright_quad(), green, Transform{.translation = {-0.9f + 0.6f * i++, 0.05f, 0},
                                                      .rotation = rotation_from_euler_deg({-20, turn, 0}), .scale = glm::vec3(0.7f)});
    expect_agreement(scene, effort, {0.001, 0.002, 0.02});
}

TEST_F(SurfaceParity, MirroredAndUnevenlyScaledInstancesWithNormalMapsAgree) {
    Material bumpy;
    bumpy.base_color = {0.8f, 0.5f, 0.3f};
    bumpy.roughness = 0.5f;
    // Normals tilted to the right, up, the left and down.
    bumpy.normal_texture.texture =
        add_texels(2, 2, TextureFormat::linear8, {180, 128, 240, 255, 128, 180, 240, 255, 76, 128, 240, 255, 128, 76, 240, 255});
    const MaterialId material = scene.add_material(bumpy);
    const Mesh sphere = tessellate(Sphere{{0, 0, 0}, 0.35f}, 64);
    int i = 0;
    for (const glm::vec3 scale : {glm::vec3(1), glm::vec3(-1, 1, 1), glm::vec3(0.6f, 1.4f, 1), glm::vec3(-1, -0.5f, -1.5f)})
        add_mesh_node(sphere, material, Transform{.translation = {-1.0f + 0.67f * i++, 0.5f, 0},
                                                  .rotation = rotation_from_euler_deg({10, 30, 15}), .scale = scale});
    expect_agreement(scene, effort, {0.001, 0.002, 0.02});
}

}  // namespace
}  // namespace heliodon::tests
