// Light without global illumination: what surroundings are taken to reflect, what hides the sky, and illuminance of what is seen.
#include <array>
#include <numbers>

#include "convert/pack.h"
#include "engine_parity.h"
#include "realtime/camera_frame.h"
#include "shading/ambient.h"

namespace heliodon::tests {
namespace {

/// One renderer and one scene, which each test finds empty, serve all: most of what a test takes is shaders.
class Ambient : public EngineParity {
protected:
    void SetUp() override {
        if (!kept) return EngineParity::SetUp();
        renderer.emplace(std::move(*kept));
        std::vector<NodeId> nodes;
        std::vector<SensorId> sensors;
        scene.nodes().each([&](NodeId id, const Node&) { nodes.push_back(id); });
        scene.sensors().each([&](SensorId id, const Sensor&) { sensors.push_back(id); });
        for (const NodeId id : nodes) scene.remove(id);
        for (const SensorId id : sensors) scene.remove(id);
        scene.set_sky({});
        scene.set_render_settings({});
    }
    void TearDown() override {
        EngineParity::TearDown();
        kept = std::move(renderer);
    }
    static void TearDownTestSuite() { kept.reset(); }
    static inline std::optional<RealtimeRenderer> kept;
    static inline Scene scene;

    static void set(Scene& scene, AmbientLight ambient, bool occlusion) {
        RenderSettings settings = scene.render_settings();
        settings.shadow_map_size = 32;
        settings.ambient = ambient;
        settings.ambient_occlusion.on = occlusion;
        scene.set_render_settings(std::move(settings));
    }
    static Image layer(const Picture& picture, const char* name) {
        for (const Layer& layer : picture.layers)
            if (layer.name == name) return layer.image;
        ADD_FAILURE() << "no layer " << name;
        return Image(picture.image.width, picture.image.height, 3);
    }
    Picture layers(const Scene& scene, const Camera& camera, int size, int samples, std::vector<std::string> names) {
        RealtimeOptions options;
        options.width = options.height = size;
        options.samples = samples;
        options.aovs = std::move(names);
        return render(scene, camera, options);
    }
};

void set_constant_sky(Scene& scene, float luminance_nits) {
    Sky sky;
    sky.model = SkyModel::constant;
    sky.luminance_nits = glm::vec3(luminance_nits);
    scene.set_sky(sky);
}

TEST_F(Ambient, AFaceTurnedFromTheSunShowsWhatTheShellReflects) {
    const glm::vec3 albedo(0.2f, 0.4f, 0.8f);
    add_floor(scene, 1, scene.add_material(lambert(albedo)));
    const glm::vec3 way = glm::normalize(glm::vec3(0.5f, 0.6f, -0.2f));  // from below: the side that is seen gets none
    add_sun(scene, way, glm::vec3(1000));
    const Camera camera = camera_above(4, 0.5f);
    const float seen = 100;
    set_constant_sky(scene, seen);
    for (const AmbientLight kind : {AmbientLight::none, AmbientLight::constant, AmbientLight::directional}) {
        set(scene, kind, false);
        const bool directional = kind == AmbientLight::directional;
        float reflected = 1000 * (directional ? shading::shell_reflected(way.y) : shading::shell_reflected_mean) + seen;
        if (kind == AmbientLight::none) reflected = 0;
        const glm::vec3 found = render(scene, camera, 4).rgb(1, 1);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], albedo[c] * (seen + albedo[c] * reflected), 1e-3f * seen) << static_cast<int>(kind);
    }
    scene.set_sky({});
    const glm::vec3 alone = render(scene, camera, 4).rgb(1, 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(alone[c], albedo[c] * albedo[c] * 1000 * shading::shell_reflected(way.y), 0.1f);
}

TEST_F(Ambient, TheShellReflectsAFormulaSkyAsQuadratureHasItAndItsMeanEvenly) {
    const float albedo = 0.5f;
    add_floor(scene, 1, scene.add_material(lambert(glm::vec3(albedo))));
    Sky sky;
    sky.model = SkyModel::cie;  // even above, nothing below: E by a normal at angle A from the zenith is πL (1 + cos A)/2
    sky.cie_type = 5;
    sky.zenith_luminance_nits = 1000;
    sky.ground_albedo = 0;
    scene.set_sky(sky);
    const Camera camera = camera_above(4, 0.5f);
    const auto with = [&](AmbientLight kind) {
        set(scene, kind, false);
        return render(scene, camera, 4).rgb(1, 1).y;
    };
    // The shell about the upper half of the floor's directions faces down: R = ∫ (1 − cos A)/2 cos A dω / π = 1/2 − 1/3.
    const float open = with(AmbientLight::none);
    EXPECT_NEAR(open, albedo * 1000, 2);
    EXPECT_NEAR(with(AmbientLight::directional) - open, albedo * albedo * 1000 / 6, 1);
    EXPECT_NEAR(with(AmbientLight::constant) - open, albedo * albedo * 1000 / 2, 2);
}

TEST_F(Ambient, AnOpenPlaneKeepsTheWholeSkyAndAWallHidesItsShare) {
    const MaterialId grey = scene.add_material(lambert(glm::vec3(0.5f)));
    add_floor(scene, 60, grey);
    set_constant_sky(scene, 100);
    Camera camera;
    camera.position = {0, 3, 8};
    camera.target = {0, 0, 0};
    camera.vertical_fov_rad = glm::radians(60.0f);
    set(scene, AmbientLight::none, true);
    EXPECT_NEAR(render(scene, camera, 48, 2).rgb(24, 24).y, 50, 0.5f);
    // A wall without end to the sides hides (1 − cos A)/2, A the elevation of its top.
    const float height = 2;
    add_shape_node(scene, Box{{-60, 0, -3}, {60, height, -2}}, grey);
    const Picture picture = layers(scene, camera, 48, 16, {"ao"});
    const Image openness = layer(picture, "ao");
    const auto frame = realtime::camera_frame(camera, Bounds{{-60, 0, -60}, {60, 2, 60}}, 48, 48, glm::vec2(0));
    int compared = 0;
    for (int y = 22; y < 45; y += 3) {
        const glm::vec3 ray = frame.ray_corner + 24.5f * frame.ray_dx + (y + 0.5f) * frame.ray_dy;
        const glm::vec3 at = frame.position - frame.position.y / ray.y * ray;  // on the floor
        if (at.z < -1.8f || at.z > camera.position.z) continue;
        const float expected = 0.5f * (1 + std::cos(std::atan2(height, at.z + 2)));
        EXPECT_NEAR(openness.at(24, y), expected, 0.03f) << at.z;
        EXPECT_NEAR(picture.image.rgb(24, y).y, 50 * expected, 2) << at.z;
        ++compared;
    }
    EXPECT_GE(compared, 4);
}

TEST_F(Ambient, OcclusionLeavesLampsAlone) {
    const MaterialId grey = scene.add_material(lambert(glm::vec3(0.5f)));
    add_floor(scene, 2, grey);
    add_shape_node(scene, Box{{-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}}, grey);
    set_constant_sky(scene, 100);
    Camera camera;
    camera.position = {0, 2, 4};
    camera.target = {0, 0.3f, 0};
    add_point_light(scene, {1, 2, 1}, glm::vec3(1000));
    std::array<Image, 4> pictures;  // with one lamp and two of them: the sky open, the sky hidden
    for (int i = 0; i < 4; ++i) {
        if (i == 2) add_point_light(scene, {1, 2, 1}, glm::vec3(1000));
        set(scene, AmbientLight::none, i % 2 == 1);
        pictures[i] = render(scene, camera, 16);
    }
    float lamp = 0, hidden = 0;
    for (std::size_t i = 0; i < pictures[0].pixels.size(); ++i) {
        EXPECT_NEAR(pictures[2].pixels[i] - pictures[0].pixels[i], pictures[3].pixels[i] - pictures[1].pixels[i], 1e-3f);
        lamp = std::max(lamp, pictures[2].pixels[i] - pictures[0].pixels[i]);
        hidden = std::max(hidden, pictures[0].pixels[i] - pictures[1].pixels[i]);
    }
    EXPECT_GT(lamp, 10);
    EXPECT_GT(hidden, 5);
}

TEST_F(Ambient, OpennessIsOfBlackSurfacesToo) {
    add_floor(scene, 60, scene.add_material(lambert(glm::vec3(0))));
    set_constant_sky(scene, 100);
    Camera camera;
    camera.position = {0, 3, 8};
    camera.target = {0, 0, 0};
    const Image openness = layer(layers(scene, camera, 8, 1, {"ao"}), "ao");
    EXPECT_FLOAT_EQ(openness.at(4, 4), 1);
}

TEST_F(Ambient, SensorsMeasureTheLightOfOpenSurfacesWhateverSurroundingsReflect) {
    const float albedo = 0.5f;
    add_floor(scene, 1, scene.add_material(lambert(glm::vec3(albedo))));
    set_constant_sky(scene, 100);
    scene.add_sensor({"open", SensorType::illuminance, {0, 0, 0}, {0, 1, 0}, {}, {}});
    const Camera camera = camera_above(4, 0.5f);
    for (const bool occlusion : {false, true})
        for (const AmbientLight kind : {AmbientLight::none, AmbientLight::directional}) {
            set(scene, kind, occlusion);
            const auto measured = renderer->measure(scene, {});
            ASSERT_TRUE(measured);
            const double seen = render(scene, camera, 4).rgb(1, 1).y * std::numbers::pi / albedo;
            EXPECT_NEAR(measured->front().value, seen, 1e-3 * seen) << occlusion;
            const bool more = kind != AmbientLight::none && !occlusion;
            EXPECT_NEAR(seen, 100 * std::numbers::pi * (more ? 1 + albedo : 1), 0.1) << occlusion;
        }
}

TEST_F(Ambient, TheShellKnowsOfASettingSunWhatIsAboveTheHorizon) {
    const float albedo = 0.5f;
    add_floor(scene, 1, scene.add_material(lambert(glm::vec3(albedo))));
    Sky sky;
    sky.model = SkyModel::preetham;
    sky.sun_elevation_rad = 0;
    scene.set_sky(sky);
    const glm::vec3 to_sun = -convert::pack_sun(sky)->axis;
    scene.add_sensor({"sun", SensorType::illuminance, {0, 1, 0}, to_sun, {}, {}});
    scene.add_sensor({"shell", SensorType::illuminance, {0, 1, 0}, -to_sun, {}, {}});
    RealtimeOptions options;
    options.environment = false;
    set(scene, AmbientLight::constant, false);
    const auto measured = renderer->measure(scene, options);
    ASSERT_TRUE(measured);
    const double shell = measured->back().value, sun = measured->front().value - shell;
    EXPECT_GT(sun, 1);
    // Every face gets a quarter of the light's illuminance, from a shell of that albedo.
    EXPECT_NEAR(shell, 0.25 * albedo * sun, 0.02 * albedo * sun);
}

TEST_F(Ambient, WhatSurroundingsReflectIsThereAfterGlobalIllumination) {
    add_floor(scene, 1, scene.add_material(lambert(glm::vec3(0.5f))));
    Sky sky;
    sky.model = SkyModel::cie;
    sky.cie_type = 5;
    sky.zenith_luminance_nits = 1000;
    sky.ground_albedo = 0;
    scene.set_sky(sky);
    RenderSettings settings = scene.render_settings();
    settings.ambient_occlusion.on = false;
    const auto seen = [&](AmbientLight kind) {
        settings.gi = "none";
        settings.ambient = kind;
        scene.set_render_settings(RenderSettings(settings));
        return render(scene, camera_above(4, 0.5f), 4).rgb(1, 1).y;
    };
    const float without = seen(AmbientLight::none);
    settings.gi = "vct";
    settings.ambient = AmbientLight::directional;
    scene.set_render_settings(RenderSettings(settings));
    ASSERT_TRUE(renderer->update(scene));
    EXPECT_NEAR(seen(AmbientLight::directional) - without, 0.25f * 1000 / 6, 1);
}

TEST_F(Ambient, WhatHidesTheSkyReflectsItsShareOfTheShell) {
    const MaterialId grey = scene.add_material(lambert(glm::vec3(0.5f)));
    add_floor(scene, 60, grey);
    add_shape_node(scene, Box{{-60, 0, -3}, {60, 2, -2}}, grey);
    set_constant_sky(scene, 100);
    Camera camera;
    camera.position = {0, 3, 8};
    camera.target = {0, 0, 0};
    set(scene, AmbientLight::directional, true);
    const Picture picture = layers(scene, camera, 32, 8, {"ao"});
    const float open = layer(picture, "ao").at(16, 20);
    EXPECT_LT(open, 0.99f);
    EXPECT_NEAR(picture.image.rgb(16, 20).y, 0.5f * 100 * (open + (1 - open) * 0.5f), 0.2f);
}

TEST_F(Ambient, IlluminanceIsWhatSensorsMeasureInBothEngines) {
    Material polished = lambert(glm::vec3(0.1f, 0.2f, 0.9f));
    polished.model = MaterialModel::standard;
    polished.metallic = 1;
    polished.roughness = 0.3f;
    polished.emission_nits = glm::vec3(50);
    add_floor(scene, 4, scene.add_material(std::move(polished)));
    add_point_light(scene, {0.4f, 1, 0.2f}, glm::vec3(300, 200, 100));
    set_constant_sky(scene, 100);
    const Camera camera = camera_above(5, 1);
    constexpr int size = 8;
    PathTracer tracer;
    PathOptions path;
    path.width = path.height = size;
    path.samples_per_pixel = 256;
    path.aovs = {"illuminance"};
    ASSERT_TRUE(tracer.update(scene));
    const auto truth = tracer.render(scene, camera, path);
    ASSERT_TRUE(truth);
    const Image here = layer(layers(scene, camera, size, 0, {"illuminance"}), "illuminance"), there = layer(*truth, "illuminance");
    for (const glm::ivec2 pixel : {glm::ivec2(1, 2), glm::ivec2(4, 3), glm::ivec2(6, 6)})
        scene.add_sensor({"s" + std::to_string(scene.sensors().size()), SensorType::illuminance, floor_point(pixel.x, pixel.y, size, 1), {0, 1, 0}, {}, {}});
    const auto measured = renderer->measure(scene, {});
    ASSERT_TRUE(measured);
    for (const SensorReading& reading : *measured) {
        const glm::ivec2 pixel((reading.position.x + 1) * size / 2, (reading.position.z + 1) * size / 2);
        EXPECT_NEAR(units::luminance(glm::dvec3(here.rgb(pixel.x, pixel.y))), reading.value, 0.01 * reading.value) << pixel.x;
        EXPECT_NEAR(units::luminance(glm::dvec3(there.rgb(pixel.x, pixel.y))), reading.value, 0.02 * reading.value) << pixel.x;
    }
}

TEST_F(Ambient, IlluminanceHasTheBouncesThatConesFind) {
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));
    add_floor(scene, 2, white);
    add_shape_node(scene, Box{{-2, 0, -2}, {2, 2, -1.5f}}, white);
    add_point_light(scene, {0.4f, 1, 0.2f}, glm::vec3(100));
    RenderSettings settings = scene.render_settings();
    settings.gi = "vct";
    settings.voxels = 32;
    scene.set_render_settings(std::move(settings));
    constexpr int size = 8;
    RealtimeOptions options;
    options.width = options.height = size;
    options.samples = 8;
    options.gi = "vct";
    options.aovs = {"illuminance"};
    const Picture picture = render(scene, camera_above(5, 1), options);
    const Image lux = layer(picture, "illuminance");
    for (const glm::ivec2 pixel : {glm::ivec2(1, 2), glm::ivec2(4, 4)})
        scene.add_sensor({"s" + std::to_string(scene.sensors().size()), SensorType::illuminance, floor_point(pixel.x, pixel.y, size, 1), {0, 1, 0}, {}, {}});
    const auto measured = renderer->measure(scene, options);
    ASSERT_TRUE(measured);
    for (const SensorReading& reading : *measured) {
        const glm::ivec2 pixel((reading.position.x + 1) * size / 2, (reading.position.z + 1) * size / 2);
        EXPECT_NEAR(lux.at(pixel.x, pixel.y, 1), reading.value, 0.02 * reading.value) << pixel.x;
        EXPECT_NEAR(picture.image.at(pixel.x, pixel.y, 1), lux.at(pixel.x, pixel.y, 1) * 0.7f / std::numbers::pi_v<float>, 0.002 * reading.value);
    }
}

TEST_F(Ambient, FilteringTheSkyIsTimedApartFromFrames) {
    Sky sky;
    sky.model = SkyModel::hosek;
    scene.set_sky(sky);
    RealtimeOptions options;
    options.width = options.height = 4;
    options.samples = 0;
    options.frames_timed = 1;
    RealtimeStatistics statistics;
    ASSERT_TRUE(renderer->render(scene, Camera{}, options, &statistics));
    ASSERT_EQ(statistics.sky_passes.size(), 3u);
    EXPECT_GT(statistics.sky_gpu_ms, 0);
}

}  // namespace
}  // namespace heliodon::tests
