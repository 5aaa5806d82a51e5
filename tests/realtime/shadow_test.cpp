#include <algorithm>
#include <cmath>
#include <utility>

#include "test_scenes.h"

namespace heliodon::tests {
namespace {

constexpr float pi = 3.14159265f;

/// A floor with a box of half the scene's size standing on it, under a light up to one side; everything
/// scaled by `scale`. The box spans ±0.25 in x and z and is 0.5 high; the light is at (−1, 1.2, 0.1).
struct BoxScene {
    Scene scene;
    glm::vec3 light;
    float scale;

    explicit BoxScene(float scale_, bool sun) : light(glm::vec3(-1, 1.2f, 0.1f) * scale_), scale(scale_) {
        const MaterialId white = scene.add_material(lambert(glm::vec3(1)));
        add_floor(scene, 1.5f * scale, white);
        add_shape_node(scene, Box{glm::vec3(-0.25f, 0, -0.25f) * scale, glm::vec3(0.25f, 0.5f, 0.25f) * scale}, white);
        if (sun) add_sun(scene, -light, glm::vec3(pi));
        else add_point_light(scene, light, glm::vec3(pi * scale * scale));
    }
    /// Does the box stand between the light and this point of the floor? A slab test in doubles, with the
    /// distance in metres by which the ray clears or cuts the box.
    static bool box_blocks(glm::dvec3 from, glm::dvec3 direction, double size) {
        double enter = 1e-9, leave = 1e30;
        const glm::dvec3 low(-0.25 * size, 0, -0.25 * size), high(0.25 * size, 0.5 * size, 0.25 * size);
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (low[axis] - from[axis]) / direction[axis], b = (high[axis] - from[axis]) / direction[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter < leave;
    }
};

class ShadowsAtScale : public RealtimeTest, public ::testing::WithParamInterface<float> {
protected:
    /// Every pixel of the floor seen from above is lit as the formula says, or black in the box's shadow;
    /// only pixels within two texels of the shadow's edge may be either. `map_size` 0: maps as fine as the picture.
    void check(bool sun, int map_size) {
        const float scale = GetParam();
        BoxScene box(scale, sun);
        RenderSettings settings;
        settings.shadow_map_size = map_size;
        box.scene.set_render_settings(settings);
        constexpr int size = 128;
        const float half = 1.4f * scale;
        const Image image = render(box.scene, camera_above(50 * scale, half), size);
        // As the floor sees it, of a 2048² map, or the diagonal of one as wide as a pixel across the light's way to the box.
        const float texel = map_size == 0 ? std::sqrt(2.0f) * 2 * half / size / glm::normalize(box.light).y : 0.002f * scale;
        const float border = 2 * texel;
        int wrong = 0, lit = 0, dark = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const glm::vec3 p = floor_point(x, y, size, half);
                // The box as the camera sees it, and the pixels at its silhouette.
                if (std::max(std::abs(p.x), std::abs(p.z)) < 0.26f * scale) continue;
                const glm::vec3 to_light = sun ? box.light : box.light - p;
                int blocked = 0;
                for (int i = 0; i < 9; ++i) {  // it and the eight round it
                    const glm::vec3 q = p + glm::vec3(i % 3 - 1, 0, i / 3 - 1) * border;
                    blocked += BoxScene::box_blocks(q, sun ? box.light : box.light - q, scale);
                }
                const float d = glm::length(to_light);
                const float cosine = to_light.y / d;
                const float full = sun ? cosine : scale * scale * cosine / (d * d);
                if (blocked == 0) ++lit, wrong += std::abs(image.at(x, y) - full) > 1e-3f * full;
                if (blocked == 9) ++dark, wrong += image.at(x, y) != 0.0f;
            }
        EXPECT_EQ(wrong, 0) << "of " << lit << " lit and " << dark << " dark pixels";
        EXPECT_GT(lit, size * size / 2);
        EXPECT_GT(dark, size * size / (map_size == 0 ? 100 : 40));
    }
};

TEST_P(ShadowsAtScale, APointLightsShadowBeginsAtTheBoxAndNothingLitIsDarkened) { check(false, 2048); }
TEST_P(ShadowsAtScale, ASunsShadowBeginsAtTheBoxAndNothingLitIsDarkened) { check(true, 2048); }
TEST_P(ShadowsAtScale, APointLightsMapsAreAsFineAsThePicture) { check(false, 0); }
TEST_P(ShadowsAtScale, ASunsMapIsAsFineAsThePicture) { check(true, 0); }
INSTANTIATE_TEST_SUITE_P(Metres, ShadowsAtScale, ::testing::Values(1.0f, 100.0f, 1000.0f));

using Shadows = RealtimeTest;

/// The floor's brightness under a blocker made by `add_blocker`, at its shadow's centre and beside it.
template <class AddBlocker>
std::pair<float, float> shadow_and_light(RealtimeTest&, RealtimeRenderer& renderer, AddBlocker&& add_blocker) {
    Scene scene;
    add_floor(scene, 2, scene.add_material(lambert(glm::vec3(1))));
    add_blocker(scene, scene.add_material(lambert(glm::vec3(1))));
    add_point_light(scene, {0, 3, 0}, glm::vec3(100));
    Camera camera;  // from the side, below the blocker
    camera.position = {0, 0.4f, 1.9f};
    camera.target = {0, 0, 0};
    camera.vertical_fov_rad = 1.0f;
    RealtimeOptions options;
    options.width = options.height = 33;
    options.samples = 1;
    const auto picture = renderer.render(scene, camera, options);
    if (!picture) return {-1, -1};
    return {picture->image.at(16, 16), picture->image.at(16, 31)};
}

TEST_F(Shadows, AnOpenSheetBlocksFromBothSides) {
    for (const bool up : {true, false}) {
        const auto [dark, light] = shadow_and_light(*this, *renderer, [&](Scene& scene, MaterialId material) {
            const glm::vec3 u(0, 0, 1), v(1, 0, 0);
            add_shape_node(scene, Quad{{-0.5f, 1, -0.5f}, up ? u : v, up ? v : u}, material);
        });
        EXPECT_EQ(dark, 0.0f);
        EXPECT_GT(light, 1.0f);
    }
}

TEST_F(Shadows, AnInsideOutBoxBlocks) {
    const auto [dark, light] = shadow_and_light(*this, *renderer, [&](Scene& scene, MaterialId material) {
        Geometry geometry;
        geometry.mesh = tessellate(Box{{-0.5f, 0.8f, -0.5f}, {0.5f, 1.2f, 0.5f}}, 8);
        for (std::size_t i = 0; i < geometry.mesh.indices.size(); i += 3)
            std::swap(geometry.mesh.indices[i], geometry.mesh.indices[i + 1]);
        geometry.bounds = geometry.mesh.bounds();
        Node node;
        node.parts.push_back({scene.add_geometry(std::move(geometry)), material});
        scene.add_node(std::move(node));
    });
    EXPECT_EQ(dark, 0.0f);
    EXPECT_GT(light, 1.0f);
}

TEST_F(Shadows, ASelfIntersectingMeshIsLitWithoutAcne) {
    // Three squares through one another (no vertex shared along the cuts) under a light straight above: each
    // horizontal point of the top is lit exactly.
    Scene scene;
    Geometry geometry;
    Mesh& mesh = geometry.mesh;
    const auto quad = [&](glm::vec3 o, glm::vec3 u, glm::vec3 v) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec3 p : {o, o + u, o + u + v, o + v}) mesh.positions.push_back(p);
        for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
    };
    quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    quad({0, -1, -1}, {0, 0, 2}, {0, 2, 0});
    geometry.bounds = mesh.bounds();
    Node node;
    Material material = lambert(glm::vec3(1));
    material.two_sided = true;
    node.parts.push_back({scene.add_geometry(std::move(geometry)), scene.add_material(material)});
    scene.add_node(std::move(node));
    add_sun(scene, {0, -1, 0}, glm::vec3(pi));
    const Image image = render(scene, camera_above(50, 0.95f), 64);
    int wrong = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const glm::vec3 p = floor_point(x, y, 64, 0.95f);
            if (std::min(std::abs(p.x), std::abs(p.z)) < 0.04f) continue;  // the upright squares' own pixels
            wrong += std::abs(image.at(x, y) - 1.0f) > 1e-3f;
        }
    EXPECT_EQ(wrong, 0);
}

TEST_F(Shadows, AGrazingPlaneHasNoAcne) {
    // 2° above the floor's horizon.
    Scene scene;
    add_floor(scene, 1, scene.add_material(lambert(glm::vec3(1))));
    const glm::vec3 to_sun(std::cos(0.035f), std::sin(0.035f), 0);
    add_sun(scene, -to_sun, glm::vec3(1000));
    add_point_light(scene, {-1.5f, 0.05f, 0.3f}, glm::vec3(10));
    const Image image = render(scene, camera_above(50, 0.9f), 128, 4);
    const Image repeated = render(scene, camera_above(50, 0.9f), 128, 1);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const glm::vec3 to_light = glm::vec3(-1.5f, 0.05f, 0.3f) - floor_point(x, y, 128, 0.9f);
            const float expected = (1000 * to_sun.y + 10 * 0.05f / std::pow(glm::length(to_light), 3.0f)) / pi;
            ASSERT_NEAR(repeated.at(x, y), expected, 1e-3f * expected) << x << " " << y;
            ASSERT_NEAR(image.at(x, y), expected, 2e-3f * expected) << x << " " << y;
        }
}

TEST_F(Shadows, WhatStandsBehindTheCameraStillCastsItsShadow) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(1)));
    add_floor(scene, 4, white);
    add_shape_node(scene, Quad{{-1, 8, -1}, {0, 0, 2}, {2, 0, 0}}, white);
    add_sun(scene, {0, -1, 0}, glm::vec3(pi));
    const Image image = render(scene, camera_above(6, 3), 32);
    EXPECT_EQ(image.at(16, 16), 0.0f);
    EXPECT_NEAR(image.at(2, 16), 1.0f, 1e-4f);
}

TEST_F(Shadows, AMaskedPartsHolesLetLightThroughAndAreSeenThrough) {
    Scene scene;
    add_floor(scene, 2, scene.add_material(lambert(glm::vec3(1))));
    Texture texture;  // the left half is there, the right half is a hole
    texture.width = 2;
    texture.height = 1;
    texture.magnify = texture.minify = Filter::nearest;
    texture.mipmapped = false;
    texture.opaque = false;
    texture.levels = {{255, 255, 255, 255, 255, 255, 255, 0}};
    Material leaf = lambert(glm::vec3(1));
    leaf.alpha_mode = AlphaMode::mask;
    leaf.two_sided = true;
    leaf.base_color_texture.texture = scene.add_texture(std::move(texture));
    Geometry sheet;  // u runs along x
    sheet.mesh.positions = {{-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1}};
    sheet.mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    sheet.mesh.indices = {0, 1, 2, 0, 2, 3};
    sheet.bounds = sheet.mesh.bounds();
    Node node;
    node.parts.push_back({scene.add_geometry(std::move(sheet)), scene.add_material(leaf)});
    scene.add_node(std::move(node));
    add_sun(scene, {0, -1, 0}, glm::vec3(pi));
    const Image above = render(scene, camera_above(50, 1.5f), 32);
    EXPECT_NEAR(above.at(10, 16), 1.0f, 1e-4f);  // the leaf
    EXPECT_NEAR(above.at(22, 16), 1.0f, 1e-4f);  // the lit floor through its hole
    Camera below;
    below.position = {0, 0.5f, 1.5f};
    below.target = {0, 0, 0};
    below.vertical_fov_rad = 1.2f;
    const Image shadow = render(scene, below, 32);
    EXPECT_EQ(shadow.at(8, 16), 0.0f);
    EXPECT_NEAR(shadow.at(24, 16), 1.0f, 1e-4f);
}

}  // namespace
}  // namespace heliodon::tests
