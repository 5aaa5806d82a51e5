#include <algorithm>
#include <array>
#include <cmath>

#include "test_scenes.h"

namespace heliodon::tests {
namespace {

using CompactVertices = RealtimeTest;

/// A checkered, bumpy sphere under a light, its picture repeated 1 and 6 times; 8-bit display values.
struct CheckeredSpheres {
    Scene scene;
    Camera camera;

    explicit CheckeredSpheres(ConvertSettings::Precision precision) {
        scene.set_convert_settings({.shape_segments = 96, .vertex_precision = precision});
        RenderSettings settings;
        settings.shadow_map_size = 256;
        scene.set_render_settings(settings);
        Material material;
        material.roughness = 0.5f;
        material.base_color_texture.texture = add_texels(TextureFormat::srgb8, {230, 120, 40, 255, 40, 120, 230, 255});
        material.normal_texture.texture = add_texels(TextureFormat::linear8, {150, 128, 250, 255, 128, 150, 250, 255});
        add_shape_node(scene, Sphere{{-0.7f, 0, 0}, 0.6f}, scene.add_material(material));
        material.base_color_texture.uv_matrix = material.normal_texture.uv_matrix = glm::mat2(6.0f);
        add_shape_node(scene, Sphere{{0.7f, 0, 0}, 0.6f}, scene.add_material(material));
        add_point_light(scene, {1, 2, 3}, glm::vec3(60));
        camera.position = {0, 0, 4};
        camera.target = {0, 0, 0};
        camera.vertical_fov_rad = 0.7f;
        camera.ev100_override = 1.5f;
    }
    /// 64 × 64 texels in a smooth change between two.
    TextureId add_texels(TextureFormat format, std::array<std::uint8_t, 8> ends) {
        Texture texture;
        texture.width = texture.height = 64;
        texture.format = format;
        texture.mipmapped = false;
        std::vector<std::uint8_t> bytes;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const float t = 0.5f - 0.25f * (std::cos(x * 0.19634954f) + std::cos(y * 0.19634954f));
                for (int c = 0; c < 4; ++c)
                    bytes.push_back(static_cast<std::uint8_t>(std::lround(ends[c] + t * (ends[4 + c] - ends[c]))));
            }
        texture.levels = {std::move(bytes)};
        return scene.add_texture(std::move(texture));
    }
};

TEST_F(CompactVertices, ShowTheSamePictureFromAboutHalfTheBytes) {
    CheckeredSpheres full(ConvertSettings::Precision::full), compact(ConvertSettings::Precision::compact);
    RealtimeOptions options;
    options.width = options.height = 128;
    options.samples = 16;
    RealtimeStatistics full_statistics, compact_statistics;
    const Picture expected = render(full.scene, full.camera, options, &full_statistics);
    auto second = RealtimeRenderer::create({.validation = true});
    ASSERT_TRUE(second) << second.error().text();
    const auto picture = second->render(compact.scene, compact.camera, options, &compact_statistics);
    ASSERT_TRUE(picture) << picture.error().text();
    EXPECT_TRUE(second->validation_messages().empty());
    const auto shown = [&](float value) { return 255 * shading::srgb_encode(std::min(1.0f, value * shading::exposure_scale(1.5f))); };
    float largest = 0, brightest = 0;
    for (std::size_t i = 0; i < expected.image.pixels.size(); ++i) {
        largest = std::max(largest, std::abs(shown(expected.image.pixels[i]) - shown(picture->image.pixels[i])));
        brightest = std::max(brightest, shown(expected.image.pixels[i]));
    }
    EXPECT_LE(largest, 1.0f);
    EXPECT_GT(largest, 0.0f);  // it is not the same data
    EXPECT_GT(brightest, 100.0f);
    // Positions 12, normal 12 → 4, tangent 16 → 4, coordinates 8 → 4 bytes a vertex: 48 → 24.
    EXPECT_NEAR(static_cast<double>(compact_statistics.vertex_bytes), 0.5 * full_statistics.vertex_bytes, 64.0);
}

TEST_F(CompactVertices, FollowTheSettingOfALivingScene) {
    CheckeredSpheres checkered(ConvertSettings::Precision::full);
    RealtimeOptions options;
    options.width = options.height = 32;
    options.samples = 1;
    RealtimeStatistics before, after;
    (void)render(checkered.scene, checkered.camera, options, &before);
    ConvertSettings settings = checkered.scene.convert_settings();
    settings.vertex_precision = ConvertSettings::Precision::compact;
    checkered.scene.set_convert_settings(settings);
    (void)render(checkered.scene, checkered.camera, options, &after);
    EXPECT_LT(after.vertex_bytes, 0.51 * before.vertex_bytes);
}

}  // namespace
}  // namespace heliodon::tests
