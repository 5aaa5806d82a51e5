#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "realtime/live.h"
#include "test_scenes.h"

namespace heliodon::tests {
namespace {

using ManyLights = RealtimeTest;
constexpr float pi = 3.14159265f;

void set_shadow_maps(Scene& scene, int size) {
    RenderSettings settings;
    settings.shadow_map_size = size;
    scene.set_render_settings(settings);
}

TEST_F(ManyLights, SomeArePickedAndTheirMeanIsTheSumOfAll) {
    Scene scene;
    set_shadow_maps(scene, 64);
    add_floor(scene, 4, scene.add_material(lambert(glm::vec3(1))));
    std::vector<std::pair<glm::vec3, float>> lights;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 position(-3 + 6 * std::fmod(0.618034f * i, 1.0f), 0.3f + 0.005f * i, -3 + 6 * std::fmod(0.754878f * i, 1.0f));
        lights.emplace_back(position, 1.0f + i % 5);
        add_point_light(scene, position, glm::vec3(lights.back().second));
    }
    add_sun(scene, {0, -1, 0}, glm::vec3(100));
    RealtimeOptions options;
    options.width = options.height = 16;
    options.samples = 64;
    RealtimeStatistics statistics;
    const Picture picture = render(scene, camera_above(6, 3), options, &statistics);
    EXPECT_EQ(statistics.light_batches, 1);
    double expected_mean = 0, mean = 0, squares = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            // The pixel's mean, by a finer grid: near lights' spots are small.
            double expected = 0;
            for (int s = 0; s < 64; ++s) {
                const glm::vec3 point = floor_point(8 * x + s % 8, 8 * y + s / 8, 128, 3);
                double sum = 100;
                for (const auto& [position, candela] : lights) {
                    const glm::vec3 to_light = position - point;
                    sum += candela * to_light.y / std::pow(glm::length(to_light), 3.0f);
                }
                expected += sum / pi / 64;
            }
            expected_mean += expected / 256;
            mean += picture.image.at(x, y) / 256;
            squares += std::pow(picture.image.at(x, y) / expected - 1, 2) / 256;
        }
    EXPECT_NEAR(mean / expected_mean, 1, 0.003);
    EXPECT_LT(std::sqrt(squares), 0.03);  // noise of 64 samples
}

/// A sheet between a floor and a hundred lights: 600 shadow maps, more than a frame renders.
struct Canopy {
    Scene scene;
    NodeId sheet;
    Canopy() {
        set_shadow_maps(scene, 32);
        const MaterialId white = scene.add_material(lambert(glm::vec3(1)));
        add_floor(scene, 3, white);
        sheet = add_floor(scene, 1, white, 1);
        for (int i = 0; i < 100; ++i)
            add_point_light(scene, {-2 + 0.4f * (i % 10), 2, -2 + 0.4f * (i / 10)}, glm::vec3(1 + i % 3));
    }
    void move_sheet() { ASSERT_TRUE(scene.set_transform(sheet, Transform{.translation = {1, -0.3f, 0.5f}})); }
};

TEST_F(ManyLights, AStillPictureOfAMovedSceneShowsNoOlderShadow) {
    RealtimeOptions options;
    options.width = options.height = 24;
    options.samples = 4;
    Canopy canopy;
    const Picture before = render(canopy.scene, camera_above(6, 3), options);
    canopy.move_sheet();
    const Picture moved = render(canopy.scene, camera_above(6, 3), options);
    Canopy anew;
    anew.move_sheet();
    auto fresh = RealtimeRenderer::create({.validation = true});
    ASSERT_TRUE(fresh) << fresh.error().text();
    const auto expected = fresh->render(anew.scene, camera_above(6, 3), options);
    ASSERT_TRUE(expected) << expected.error().text();
    EXPECT_EQ(moved.image.pixels, expected->image.pixels);
    EXPECT_NE(moved.image.pixels, before.image.pixels);
}

TEST(LiveManyLights, ShadowsOfAMovedSheetAreRightAfterAsManyFramesAsTheirMapsTake) {
    auto instance = gpu::Instance::create({.validation = true});
    ASSERT_TRUE(instance) << instance.error().text();
    auto device = gpu::Device::create(*instance);
    ASSERT_TRUE(device) << device.error().text();
    std::vector<std::uint8_t> expected;
    const auto frame = [&](LiveRenderer& renderer, const Scene& scene, int accumulated) {
        const auto rendered = renderer.render(scene, camera_above(6, 3), 24, 24);
        if (!rendered) return ADD_FAILURE() << rendered.error().text(), std::vector<std::uint8_t>{};
        EXPECT_EQ(rendered->accumulated_frames, accumulated);
        return (*device)->read_back_as<std::uint8_t>(*rendered->image).value();
    };
    {
        Canopy anew;
        anew.move_sheet();
        auto renderer = LiveRenderer::create(**device);
        ASSERT_TRUE(renderer) << renderer.error().text();
        expected = frame(*renderer, anew.scene, 1);
    }
    {
        Canopy canopy;
        auto renderer = LiveRenderer::create(**device);
        ASSERT_TRUE(renderer) << renderer.error().text();
        for (int i = 1; i <= 3; ++i) EXPECT_NE(frame(*renderer, canopy.scene, i), expected);
        canopy.move_sheet();
        EXPECT_NE(frame(*renderer, canopy.scene, 1), expected);  // 384 maps of 600
        EXPECT_EQ(frame(*renderer, canopy.scene, 1), expected);
        frame(*renderer, canopy.scene, 2);
    }
    for (const std::string& message : (*device)->validation_messages()) ADD_FAILURE() << message;
}

TEST_F(ManyLights, TwiceTheLightIsTwiceThePicture) {
    Canopy canopy;
    RealtimeOptions options;
    options.width = options.height = 24;
    options.samples = 16;
    const Picture before = render(canopy.scene, camera_above(6, 3), options);
    for (std::uint32_t i = 0; i < canopy.scene.nodes().capacity(); ++i)
        if (const Node* node = canopy.scene.nodes().at(i); node && node->light) {
            Light light = *node->light;
            light.intensity *= 2.0f;
            ASSERT_TRUE(canopy.scene.set_light(canopy.scene.nodes().id_at(i), light));
        }
    const Picture twice = render(canopy.scene, camera_above(6, 3), options);
    for (std::size_t i = 0; i < before.image.pixels.size(); ++i)
        ASSERT_NEAR(twice.image.pixels[i], 2 * before.image.pixels[i], 1e-4f * before.image.pixels[i]) << i;
}

}  // namespace
}  // namespace heliodon::tests
