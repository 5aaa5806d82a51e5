#include "realtime/live.h"

#include <cmath>

#include "shared_data.h"
#include "test_scenes.h"

namespace heliodon::tests {
namespace {

class Live : public ::testing::Test {
protected:
    void SetUp() override {
        auto instance = gpu::Instance::create({.validation = true});
        ASSERT_TRUE(instance) << instance.error().text();
        auto created = gpu::Device::create(*instance);
        ASSERT_TRUE(created) << created.error().text();
        device = std::move(*created);
        auto made = LiveRenderer::create(*device);
        ASSERT_TRUE(made) << made.error().text();
        renderer.emplace(std::move(*made));
    }
    void TearDown() override {
        renderer.reset();
        if (!device) return;
        for (const std::string& message : device->validation_messages()) ADD_FAILURE() << message;
    }
    int frame(const Scene& scene, const Camera& camera, int size = 16) {
        const auto rendered = renderer->render(scene, camera, size, size);
        if (!rendered) {
            ADD_FAILURE() << rendered.error().text();
            return -1;
        }
        image = rendered->image;
        return rendered->accumulated_frames;
    }
    /// One display-encoded channel of the last frame.
    int value(int x, int y, int size = 16) {
        const auto bytes = device->read_back_as<std::uint8_t>(*image);
        return bytes ? (*bytes)[4 * (static_cast<std::size_t>(y) * size + x)] : -1;
    }

    std::unique_ptr<gpu::Device> device;
    std::optional<LiveRenderer> renderer;
    const gpu::Image* image = nullptr;
};

TEST_F(Live, FramesAccumulateWhileNothingChangesAndStartAnewWhenSomethingDoes) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(1)));
    add_floor(scene, 4, white);
    const NodeId sheet = add_floor(scene, 1, white, 8);
    add_sun(scene, {0, -1, 0}, glm::vec3(3.14159265f * 9.6f));
    Camera camera = camera_above(6, 3);
    for (int i = 1; i <= 12; ++i) EXPECT_EQ(frame(scene, camera), i);
    EXPECT_EQ(value(8, 8), 0);
    // Radiance 9.6 at EV100 3 is 1 before the tone curve: Hable makes .493 of it, sRGB 186.
    EXPECT_NEAR(value(1, 1), 186, 1);
    ASSERT_TRUE(scene.set_transform(sheet, Transform{.translation = {20, 0, 0}}));
    EXPECT_EQ(frame(scene, camera), 1);
    EXPECT_NEAR(value(8, 8), 186, 1);
    EXPECT_EQ(frame(scene, camera), 2);
    camera.position.x += 0.1f;
    EXPECT_EQ(frame(scene, camera), 1);
    EXPECT_EQ(frame(scene, camera, 8), 1);  // another size
    EXPECT_EQ(frame(scene, camera, 8), 2);
    scene.set_render_settings({.gi = "vct", .voxels = 32});
    EXPECT_EQ(frame(scene, camera, 8), 1);
    EXPECT_EQ(frame(scene, camera, 8), 2);
    scene.set_render_settings({});
    EXPECT_EQ(frame(scene, camera, 8), 1);
    ASSERT_TRUE(scene.set_material(white, lambert(glm::vec3(0))));
    EXPECT_EQ(frame(scene, camera, 8), 1);
    EXPECT_EQ(value(1, 1, 8), 0);
    EXPECT_FALSE(renderer->pass_times().empty());
}

using Layers = RealtimeTest;

TEST_F(Layers, DepthPositionNormalAndAlbedoAreOfWhatThePixelSees) {
    Scene scene;
    add_floor(scene, 1, scene.add_material(lambert({0.2f, 0.4f, 0.6f})));
    RealtimeOptions options;
    options.width = options.height = 8;
    options.samples = 4;
    options.aovs = {"depth", "position", "normal", "albedo", "direct", "indirect"};
    add_sun(scene, {0, -1, 0}, glm::vec3(3.14159265f));
    const Picture picture = render(scene, camera_above(6, 2), options);
    ASSERT_EQ(picture.layers.size(), 6u);
    EXPECT_NEAR(picture.layers[0].image.at(4, 4), 6, 1e-4f);
    EXPECT_EQ(picture.layers[0].image.at(0, 0), 0);
    const glm::vec3 expected = floor_point(4, 3, 8, 2);
    EXPECT_NEAR(picture.layers[1].image.at(4, 3, 0), expected.x, 1e-4f);
    EXPECT_NEAR(picture.layers[1].image.at(4, 3, 2), expected.z, 1e-4f);
    EXPECT_NEAR(picture.layers[2].image.at(4, 4, 1), 1, 1e-5f);
    EXPECT_NEAR(picture.layers[3].image.at(4, 4, 2), 0.6f, 1e-5f);
    EXPECT_NEAR(picture.layers[4].image.at(4, 4, 1), picture.image.at(4, 4, 1), 1e-6f);
    EXPECT_EQ(picture.layers[5].image.at(4, 4, 1), 0);
}

TEST_F(Layers, AnUnknownLayerIsRefusedByName) {
    RealtimeOptions options;
    options.aovs = {"colour"};
    const auto picture = renderer->render(Scene{}, Camera{}, options);
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().text().find("colour"), std::string::npos);
}

}  // namespace
}  // namespace heliodon::tests
