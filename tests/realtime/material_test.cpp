#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "test_scenes.h"

namespace heliodon::tests {
namespace {

using Furnace = RealtimeTest;

Camera camera_at_sphere() {
    Camera camera;
    camera.position = {0, 0, 4};
    camera.target = {0, 0, 0};
    camera.vertical_fov_rad = 2 * std::asin(1.0f / 4);  // the sphere touches the picture's edges
    camera.ev100_override = 0.0f;
    return camera;
}

/// Least and greatest value over the sphere's pixels under a sky of 1.
std::pair<float, float> range(const Image& image) {
    float low = 1e9f, high = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float r = std::hypot(2 * (x + 0.5f) / image.width - 1, 2 * (y + 0.5f) / image.height - 1);
            if (r > 0.97f) continue;
            for (int c = 0; c < 3; ++c) {
                low = std::min(low, image.at(x, y, c));
                high = std::max(high, image.at(x, y, c));
            }
        }
    return {low, high};
}

TEST_F(Furnace, ASphereOfEveryRoughnessAndMetalnessUnderAnEvenSkyReturnsItWithinHalfAPercent) {
    Scene scene;
    Material material;
    material.base_color = glm::vec3(1);
    const MaterialId id = scene.add_material(material);
    add_shape_node(scene, Sphere{}, id);
    scene.set_sky({.model = SkyModel::constant, .luminance_nits = glm::vec3(1)});
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.0f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f}) {
            material.metallic = metallic;
            material.roughness = roughness;
            ASSERT_TRUE(scene.set_material(id, material));
            const auto [low, high] = range(render(scene, camera_at_sphere(), 24));
            EXPECT_GE(low, 0.995f) << "metallic " << metallic << " roughness " << roughness;
            EXPECT_LE(high, 1.005f) << "metallic " << metallic << " roughness " << roughness;
        }
}

TEST_F(Furnace, ALambertSphereOfAlbedoOneHalfReturnsExactlyHalf) {
    Scene scene;
    add_shape_node(scene, Sphere{}, scene.add_material(lambert(glm::vec3(0.5f))));
    scene.set_sky({.model = SkyModel::constant, .luminance_nits = glm::vec3(1)});
    const auto [low, high] = range(render(scene, camera_at_sphere(), 32));
    EXPECT_EQ(low, 0.5f);
    EXPECT_EQ(high, 0.5f);
}

TEST_F(Furnace, WithoutTheEnvironmentTheSkyIsBlackAndLightsNothing) {
    Scene scene;
    add_shape_node(scene, Sphere{}, scene.add_material(lambert(glm::vec3(0.5f))));
    scene.set_sky({.model = SkyModel::constant, .luminance_nits = glm::vec3(1)});
    RealtimeOptions options;
    options.width = options.height = 16;
    options.samples = 1;
    EXPECT_EQ(render(scene, camera_at_sphere(), options).image.at(0, 0), 1.0f);
    options.environment = false;
    const Picture dark = render(scene, camera_at_sphere(), options);
    for (const float value : dark.image.pixels) ASSERT_EQ(value, 0.0f);
}

/// An equirectangular sky of `width` × `width`/2 texels with its mip chain.
template <class Radiance>
TextureId add_sky_image(Scene& scene, int width, Radiance&& radiance) {
    Texture texture;
    texture.width = width;
    texture.height = width / 2;
    texture.format = TextureFormat::float32;
    texture.wrap_v = Wrap::clamp_to_edge;
    std::vector<glm::vec4> level(static_cast<std::size_t>(width) * width / 2);
    for (int y = 0; y < width / 2; ++y)
        for (int x = 0; x < width; ++x) level[y * width + x] = glm::vec4(radiance((x + 0.5f) / width, (y + 0.5f) / (width / 2)), 1);
    int w = width, h = width / 2;
    for (;;) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(level.data());
        texture.levels.emplace_back(bytes, bytes + level.size() * sizeof(glm::vec4));
        if (w == 1 && h == 1) break;
        const int next_w = std::max(1, w / 2), next_h = std::max(1, h / 2);
        std::vector<glm::vec4> next(static_cast<std::size_t>(next_w) * next_h);
        for (int y = 0; y < next_h; ++y)
            for (int x = 0; x < next_w; ++x) {
                const int x1 = std::min(2 * x + 1, w - 1), y1 = std::min(2 * y + 1, h - 1);
                next[y * next_w + x] = 0.25f * (level[2 * y * w + 2 * x] + level[2 * y * w + x1] + level[y1 * w + 2 * x] + level[y1 * w + x1]);
            }
        level = std::move(next);
        w = next_w;
        h = next_h;
    }
    return scene.add_texture(std::move(texture));
}

TEST_F(Furnace, AnEvenImageSkyLightsLikeAConstantOne) {
    Scene scene;
    Material material;
    material.base_color = glm::vec3(1);
    const MaterialId id = scene.add_material(material);
    add_shape_node(scene, Sphere{}, id);
    scene.set_sky({.model = SkyModel::image, .luminance_nits = glm::vec3(1),
                   .image = add_sky_image(scene, 64, [](float, float) { return glm::vec3(1); })});
    for (const float roughness : {0.0f, 0.4f, 1.0f}) {
        material.roughness = roughness;
        ASSERT_TRUE(scene.set_material(id, material));
        const auto [low, high] = range(render(scene, camera_at_sphere(), 24));
        EXPECT_GE(low, 0.995f);
        EXPECT_LE(high, 1.005f);
    }
}

TEST_F(Furnace, AHalfBrightSkyLightsALambertPlaneByTheShareItSees) {
    // The upper hemisphere shines with 1, the lower not: a surface whose normal rises by the angle e above the
    // horizon sees (1 + sin e)/2 of it.
    Scene scene;
    const TextureId image = add_sky_image(scene, 256, [](float, float v) { return glm::vec3(v < 0.5f ? 1.0f : 0.0f); });
    scene.set_sky({.model = SkyModel::image, .luminance_nits = glm::vec3(1), .image = image});
    add_shape_node(scene, Sphere{}, scene.add_material(lambert(glm::vec3(1))));
    Camera camera = camera_at_sphere();
    camera.vertical_fov_rad = 1e-3f;
    EXPECT_NEAR(render(scene, camera, 1).at(0, 0), 0.5f, 0.005f);
    camera.position = {0, 4, 0};
    camera.up = {0, 0, -1};
    EXPECT_NEAR(render(scene, camera, 1).at(0, 0), 1.0f, 0.005f);
    camera.position = {0, -4, 0};
    EXPECT_NEAR(render(scene, camera, 1).at(0, 0), 0.0f, 0.005f);
}

using Blending = RealtimeTest;

TEST_F(Blending, ThreeSheetsComposeFromBackToFrontInEveryOrderOfDrawing) {
    const std::array<glm::vec3, 3> colors{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)};
    std::array<int, 3> order{0, 1, 2};
    do {
        Scene scene;
        Material white;
        white.model = MaterialModel::unlit;
        white.base_color = glm::vec3(1);
        white.emission_nits = glm::vec3(1);
        add_floor(scene, 2, scene.add_material(white));
        for (const int i : order) {
            Material sheet = white;
            sheet.base_color = colors[i];
            sheet.alpha_mode = AlphaMode::blend;
            sheet.opacity = 0.5f;
            add_floor(scene, 1, scene.add_material(sheet), 1.0f + i);
        }
        const Image image = render(scene, camera_above(50, 2), 16);
        // Over white: half red, then half green, then half blue.
        EXPECT_NEAR(image.at(8, 8, 0), ((0.5f + 0.5f) * 0.5f) * 0.5f, 1e-5f);
        EXPECT_NEAR(image.at(8, 8, 1), (0.25f + 0.5f) * 0.5f, 1e-5f);
        EXPECT_NEAR(image.at(8, 8, 2), 0.125f + 0.5f, 1e-5f);
        EXPECT_NEAR(image.at(0, 0, 0), 1.0f, 1e-5f);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST_F(Blending, MoreLayersThanThereIsRoomForAtFirstAreAllDrawn) {
    Scene scene;
    Material sheet;
    sheet.model = MaterialModel::unlit;
    sheet.base_color = glm::vec3(1);
    sheet.emission_nits = glm::vec3(1);
    sheet.alpha_mode = AlphaMode::blend;
    sheet.opacity = 0.1f;
    const MaterialId material = scene.add_material(sheet);
    for (int i = 0; i < 20; ++i) add_floor(scene, 2, material, 0.1f * i);
    const Image image = render(scene, camera_above(50, 1), 16);
    for (int i = 0; i < 16; ++i) EXPECT_NEAR(image.at(i, i), 1 - std::pow(0.9f, 20.0f), 1e-5f);
}

TEST_F(Blending, ABlendedSheetLetsItsShareOfLightThrough) {
    Scene scene;
    add_floor(scene, 2, scene.add_material(lambert(glm::vec3(1))));
    Material glass = lambert(glm::vec3(0));
    glass.alpha_mode = AlphaMode::blend;
    glass.opacity = 0.25f;
    add_floor(scene, 1, scene.add_material(glass), 1);
    add_sun(scene, {0, -1, 0}, glm::vec3(3.14159265f));
    Camera camera;
    camera.position = {0, 0.5f, 1.9f};
    camera.target = {0, 0, 0};
    camera.vertical_fov_rad = 0.1f;
    const Image image = render(scene, camera, 16, 64);
    double mean = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) mean += image.at(x, y) / 256.0;
    EXPECT_NEAR(mean, 0.75, 0.01);
}

}  // namespace
}  // namespace heliodon::tests
