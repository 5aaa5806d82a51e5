#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/image_io.h"
#include "realtime/renderer.h"
#include "scene/scene.h"
#include "shading/tone.h"

namespace heliodon::tests {

/// A renderer with the validation layer; every test ends by asking it for messages.
class RealtimeTest : public ::testing::Test {
protected:
    void SetUp() override {
        auto created = RealtimeRenderer::create({.validation = true});
        ASSERT_TRUE(created) << created.error().text();
        renderer.emplace(std::move(*created));
    }
    void TearDown() override {
        if (!renderer) return;
        for (const std::string& message : renderer->validation_messages()) ADD_FAILURE() << message;
    }

    Image render(const Scene& scene, const Camera& camera, int size, int samples = 1) {
        RealtimeOptions options;
        options.width = options.height = size;
        options.samples = samples;
        return render(scene, camera, options).image;
    }
    Picture render(const Scene& scene, const Camera& camera, const RealtimeOptions& options,
                   RealtimeStatistics* statistics = nullptr) {
        auto picture = renderer->render(scene, camera, options, statistics);
        if (!picture) {
            ADD_FAILURE() << picture.error().text();
            return {Image(options.width, options.height, 3), {}, 0, false};
        }
        save(*picture);
        return *picture;
    }
    /// HELIODON_TEST_PICTURES names a folder: every picture of a test goes there, to be looked at.
    void save(const Picture& picture) {
        const char* folder = std::getenv("HELIODON_TEST_PICTURES");
        if (!folder || !*folder) return;
        Picture shown = picture;
        for (std::size_t i = 0; i + 2 < shown.image.pixels.size(); i += 3) {
            float* p = &shown.image.pixels[i];
            const glm::vec3 encoded = shading::srgb_encode_rgb(
                shading::tone_hable(glm::vec3(p[0], p[1], p[2]) * shading::exposure_scale(picture.ev100), shading::hable_white));
            for (int c = 0; c < 3; ++c) p[c] = encoded[c];
        }
        std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        std::replace(name.begin(), name.end(), '/', '-');  // parameters of a test
        shown.layers.clear();
        const auto written =
            write_picture(std::filesystem::path(folder) / (name + std::to_string(saved++) + ".png"), shown);
        if (!written) ADD_FAILURE() << written.error().text();
    }

    std::optional<RealtimeRenderer> renderer;
    int saved = 0;
};

inline Material lambert(glm::vec3 albedo) {
    Material material;
    material.model = MaterialModel::lambert;
    material.base_color = albedo;
    return material;
}

inline NodeId add_shape_node(Scene& scene, Shape shape, MaterialId material, const Transform& transform = {}) {
    Node node;
    node.transform = transform;
    node.parts.push_back({scene.add_shape(std::move(shape)), material});
    return scene.add_node(std::move(node));
}

/// A horizontal square facing up, `half` metres to each side of the origin.
inline NodeId add_floor(Scene& scene, float half, MaterialId material, float height = 0) {
    return add_shape_node(scene, Quad{{-half, height, -half}, {0, 0, 2 * half}, {2 * half, 0, 0}}, material);
}

inline NodeId add_point_light(Scene& scene, glm::vec3 position, glm::vec3 intensity_cd) {
    Node node;
    node.transform.translation = position;
    node.light = Light{.type = LightType::point, .intensity = intensity_cd};
    return scene.add_node(std::move(node));
}

inline NodeId add_sun(Scene& scene, glm::vec3 direction, glm::vec3 lux) {
    Node node;
    node.light = Light{.type = LightType::directional, .intensity = lux, .direction = glm::normalize(direction)};
    return scene.add_node(std::move(node));
}

/// Looks straight down at the origin from `height`; the picture's top is −Z. Covers 2·`half` metres.
inline Camera camera_above(float height, float half) {
    Camera camera;
    camera.position = {0, height, 0};
    camera.target = {0, 0, 0};
    camera.up = {0, 0, -1};
    camera.vertical_fov_rad = 2 * std::atan(half / height);
    camera.ev100_override = 3.0f;
    return camera;
}
/// The point of the plane y = 0 at the centre of a pixel of such a camera's picture.
inline glm::vec3 floor_point(int x, int y, int size, float half) {
    return {(2 * (x + 0.5f) / size - 1) * half, 0, (2 * (y + 0.5f) / size - 1) * half};
}

}  // namespace heliodon::tests
