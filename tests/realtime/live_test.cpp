#include "realtime/live.h"

#include <cmath>

#include "convert/display.h"
#include "core/units.h"
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

/// A uniform picture: a sky of `nits` and nothing else.
Scene uniform_sky(float nits, const DisplaySettings& display) {
    Scene scene;
    Sky sky;
    sky.model = SkyModel::constant;
    sky.luminance_nits = glm::vec3(nits);
    scene.set_sky(sky);
    RenderSettings settings = scene.render_settings();
    settings.display = display;
    scene.set_render_settings(settings);
    return scene;
}
/// Linear value of an exposure of exactly what the meter says: L/(1.2·8·L).
constexpr float metered_value = 1 / 9.6f;

TEST_F(Live, AMeteredExposureIsRightAtOnceAndAdaptsInTimeToWhatChanges) {
    const DisplaySettings display{.tone = {.curve = ToneCurve::linear},
                                  .exposure = {.mode = ExposureMode::metered, .to_light_s = 0.4f, .to_dark_s = 1.2f}};
    const Camera camera = camera_above(6, 3);
    const auto shown_after = [&](const Scene& scene, float seconds) {
        const auto rendered = renderer->render(scene, camera, 16, 16, true, seconds);
        EXPECT_TRUE(rendered) << rendered.error().text();
        image = rendered->image;
        return units::srgb_decode(static_cast<float>(value(8, 8)) / 255);
    };
    Scene scene = uniform_sky(100, display);
    EXPECT_NEAR(shown_after(scene, 0), metered_value, 2e-3f) << "the first picture has nothing to adapt from";
    Sky sky = scene.sky();
    sky.luminance_nits = glm::vec3(200);
    scene.set_sky(sky);
    EXPECT_NEAR(shown_after(scene, 0), 2 * metered_value, 3e-3f) << "at first as exposed before";
    const float remaining = std::exp(-1.0f);  // of one stop, after one time constant
    EXPECT_NEAR(shown_after(scene, 0.4f), metered_value * std::exp2(remaining), 2e-3f);
    for (int i = 0; i < 20; ++i) shown_after(scene, 0.1f);
    EXPECT_NEAR(shown_after(scene, 0.1f), metered_value, 2e-3f) << "settled";
    sky.luminance_nits = glm::vec3(100);
    scene.set_sky(sky);
    shown_after(scene, 0);
    EXPECT_NEAR(shown_after(scene, 1.2f), metered_value * std::exp2(-remaining), 2e-3f) << "slower to dark";
}

TEST_F(Live, WhatIsShownIsWhatTheFilesShow) {
    for (const ToneCurve curve : {ToneCurve::linear, ToneCurve::hable, ToneCurve::reinhard, ToneCurve::aces, ToneCurve::agx,
                                  ToneCurve::neutral}) {
        const DisplaySettings display{.tone = {.curve = curve}, .exposure = {.mode = ExposureMode::key, .compensation_ev = 1},
                                      .white_balance = glm::vec2(0.40f, 0.39f)};
        const Scene scene = uniform_sky(50, display);
        frame(scene, camera_above(6, 3));
        Image light(16, 16, 3, 50.0f);
        const float ev100 = convert::exposure_ev100(display.exposure, convert::meter(light, display.exposure), 0);
        const Image shown = convert::displayed(light, display, ev100);
        const auto bytes = device->read_back_as<std::uint8_t>(*image);
        ASSERT_TRUE(bytes);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR((*bytes)[4 * (8 * 16 + 8) + c], 255 * shown.at(8, 8, c), 1.01f) << static_cast<int>(curve);
    }
}

}  // namespace
}  // namespace heliodon::tests
