// Skies by formula and panes in the real-time engine, against quadrature and the path tracer; what its sensors say of
// their noise.
#include <cmath>

#include "convert/pack.h"
#include "engine_parity.h"
#include "shading/cie_sky.h"
#include "shading/sky.h"

namespace heliodon::tests {
namespace {

Sky cie_sky(int type, float elevation_deg = 60) {
    Sky sky;
    sky.model = SkyModel::cie;
    sky.cie_type = type;
    sky.zenith_luminance_nits = 1000;
    sky.ground_albedo = 0.3f;
    sky.sun_azimuth_rad = 0.7f;
    sky.sun_elevation_rad = glm::radians(elevation_deg);
    sky.north_rad = 0.2f;
    return sky;
}

class Daylight : public EngineParity {
protected:
    std::vector<SensorReading> measure(const Scene& scene, bool environment = true) {
        RealtimeOptions options;
        options.environment = environment;
        auto readings = renderer->measure(scene, options);
        if (!readings) ADD_FAILURE() << readings.error().text();
        return readings ? *readings : std::vector<SensorReading>{};
    }
    /// Small shadow maps: sensors take many of them.
    static Scene small_shadows() {
        Scene scene;
        RenderSettings settings = scene.render_settings();
        settings.shadow_map_size = 128;
        scene.set_render_settings(settings);
        return scene;
    }
    static std::vector<SensorReading> trace(const Scene& scene, int max_depth = 1) {
        PathTracer tracer;
        EXPECT_TRUE(tracer.update(scene));
        PathOptions options;
        options.samples_per_pixel = 1 << 14;
        options.max_depth = max_depth;
        auto readings = tracer.measure(scene, options);
        EXPECT_TRUE(readings);
        return *readings;
    }
};

TEST_F(Daylight, PlanesUnderCieSkiesReceiveWhatQuadratureAndThePathTracerSay) {
    Scene scene;
    for (const glm::vec3 normal : {glm::vec3(0, 1, 0), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(0, -1, 0)})
        scene.add_sensor({"s" + std::to_string(scene.sensors().size()), SensorType::illuminance, {0, 0, 0}, normal, {}, {}});
    for (const int type : {1, 5, 12, 16}) {
        scene.set_sky(cie_sky(type));
        const auto here = measure(scene), truth = trace(scene);
        EXPECT_NEAR(here[0].value / shading::horizontal_illuminance(convert::pack_sky(scene)), 1, 0.003) << type;
        for (std::size_t i = 0; i < here.size(); ++i)
            EXPECT_NEAR(here[i].value, truth[i].value, 0.004 * truth[i].value + 3 * truth[i].half_width_95) << type << ' ' << i;
    }
}

TEST_F(Daylight, ACieSkyIsSeenAsItIs) {
    Scene scene;
    scene.set_sky(cie_sky(12, 30));
    const shading::SkyData sky = convert::pack_sky(scene);
    for (const glm::vec3 direction : {glm::vec3(0, 1, 0), glm::vec3(.5f, .3f, -.7f), glm::vec3(-.6f, .02f, .3f), glm::vec3(.3f, -.5f, .2f)})
        scene.add_sensor({"s" + std::to_string(scene.sensors().size()), SensorType::luminance, {0, 0, 0}, direction, {}, {}});
    std::size_t i = 0;
    for (const SensorReading& reading : measure(scene)) {
        const glm::vec3 direction = glm::normalize(scene.sensors().at(static_cast<std::uint32_t>(i++))->direction);
        const double expected = shading::sky_radiance(sky, direction, glm::vec3(1)).x;
        EXPECT_NEAR(reading.value, expected, 1e-3 * expected);
        EXPECT_EQ(reading.half_width_95, 0);
    }
}

TEST_F(Daylight, APictureIsLitAnewWhereTheSkyChanges) {
    Scene scene;
    scene.set_sky(cie_sky(1));
    scene.add_sensor({"s", SensorType::illuminance, {0, 0, 0}, {0, 1, 0}, {}, {}});
    const double overcast = measure(scene)[0].value;
    Sky brighter = cie_sky(1);
    brighter.zenith_luminance_nits = 3000;
    scene.set_sky(brighter);
    EXPECT_NEAR(measure(scene)[0].value, 3 * overcast, 0.01 * overcast);
    Sky none;
    scene.set_sky(none);
    EXPECT_EQ(measure(scene)[0].value, 0);
}

Material clear_glass() {
    Material material;
    material.model = MaterialModel::thin;
    material.transmittance = {-.028378f, 3.156075f, -3.058376f, -1.428919f, 4.014235f, -1.775827f};
    return material;
}

TEST_F(Daylight, APaneLetsABeamAndALampThroughByTheAngleOfEachRay) {
    Scene scene = small_shadows();
    add_floor(scene, 9, scene.add_material(lambert(glm::vec3(0))));
    add_shape_node(scene, Quad{{-9, 1, -9}, {0, 0, 18}, {18, 0, 0}}, scene.add_material(clear_glass()));
    const NodeId sun = scene.add_node({}), lamp = scene.add_node({});
    scene.set_light(lamp, Light{.type = LightType::point, .intensity = glm::vec3(3000)});
    for (const float x : {0.0f, 0.1f})
        scene.add_sensor({"s" + std::to_string(scene.sensors().size()), SensorType::illuminance, {x, 0, 0}, {0, 1, 0}, {}, {}});
    for (const float angle_deg : {20.0f, 65.0f}) {
        const float angle = glm::radians(angle_deg);
        scene.set_light(sun, Light{.type = LightType::directional, .intensity = glm::vec3(1000), .direction = {std::sin(angle), -std::cos(angle), 0}});
        scene.set_transform(lamp, {.translation = {2 * std::tan(angle), 2, 0}});
        const auto here = measure(scene, false), truth = trace(scene);
        for (std::size_t i = 0; i < here.size(); ++i) {
            EXPECT_GT(here[i].half_width_95, 0) << "the shadow of a pane is a matter of chance";
            EXPECT_NEAR(here[i].value, truth[i].value, 2.5 * here[i].half_width_95 + 0.01 * truth[i].value) << angle_deg;
        }
    }
}

TEST_F(Daylight, ThroughAPaneBothEnginesShowTheSame) {
    Scene scene = small_shadows();
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));
    add_floor(scene, 2, white);
    add_shape_node(scene, Box{{-0.3f, 0, -0.9f}, {0.3f, 0.6f, -0.5f}}, white);
    Material tinted = clear_glass();
    for (float& coefficient : tinted.transmittance) coefficient *= 0.6f;
    add_shape_node(scene, Quad{{-0.8f, 0, 0.2f}, {1.6f, 0, 0}, {0, 1.2f, 0}}, scene.add_material(tinted));
    Node lamp;
    lamp.transform.translation = {0.5f, 1.4f, 1.2f};
    lamp.light = Light{.type = LightType::point, .intensity = glm::vec3(6)};
    scene.add_node(lamp);
    Camera camera;
    camera.position = {0.9f, 0.9f, 2.6f};
    camera.target = {0, 0.4f, 0};
    camera.vertical_fov_rad = 0.8f;
    camera.ev100_override = 1.0f;
    scene.add_camera(camera);
    expect_agreement(scene, {96, 128, 64}, {0.03, 0.005, 0.02});
}

TEST_F(Daylight, SensorsInAPenumbraStateAHalfWidthThatHoldsTheTruth) {
    Scene scene = small_shadows();
    add_shape_node(scene, Quad{{0, 1, -2}, {0, 0, 4}, {2, 0, 0}}, scene.add_material(lambert(glm::vec3(0))));
    Node lamp;
    lamp.transform.translation = {0, 2, 0};
    lamp.light = Light{.type = LightType::point, .intensity = glm::vec3(100), .radius_m = 0.3f};
    scene.add_node(lamp);
    for (const float x : {-0.2f, -0.1f, 0.0f, 0.1f})
        scene.add_sensor({"s" + std::to_string(scene.sensors().size()), SensorType::illuminance, {x, 0, 0}, {0, 1, 0}, {}, {}});
    const auto here = measure(scene), truth = trace(scene);
    for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_GT(here[i].half_width_95, 0);
        EXPECT_LT(here[i].half_width_95, 0.3 * here[i].value);
        EXPECT_NEAR(here[i].value, truth[i].value, 2 * here[i].half_width_95 + truth[i].half_width_95 + 0.005 * truth[i].value) << i;
    }
}

}  // namespace
}  // namespace heliodon::tests
