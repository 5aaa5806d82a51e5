#include <gtest/gtest.h>

#include <cmath>

#include "scene/scene.h"

namespace heliodon {
namespace {

class Animated : public ::testing::Test {
protected:
    Scene scene;
    NodeId node = scene.add_node({.light = Light{.type = LightType::spot, .inner_rad = 0.1f, .outer_rad = 0.5f}});
    CameraId camera = scene.add_camera({.name = "camera"});
    MaterialId material = scene.add_material({.name = "material"});

    template <class Target>
    void animate(AnimatedProperty property, Target target, Interpolation interpolation, std::vector<float> times_s,
                 std::vector<float> values) {
        scene.add_animation({"", {{property, target, interpolation, std::move(times_s), std::move(values)}}});
    }
    template <class Target>
    void set(AnimatedProperty property, Target target, std::vector<float> value) {
        animate(property, target, Interpolation::step, {0}, std::move(value));
    }
    [[nodiscard]] const Node& the_node() const { return *scene.nodes().find(node); }
};

TEST_F(Animated, EveryPropertyTakesItsValue) {
    using enum AnimatedProperty;
    set(node_translation, node, {1, 2, 3});
    set(node_rotation, node, {0, 1, 0, 0});
    set(node_scale, node, {4, 5, 6});
    set(node_visible, node, {0});
    set(light_intensity, node, {7, 8, 9});
    set(light_inner_rad, node, {0.2f});
    set(light_outer_rad, node, {0.3f});
    set(light_radius_m, node, {0.4f});
    set(light_direction, node, {0, 2, 0});
    set(camera_position, camera, {1, 1, 1});
    set(camera_target, camera, {2, 2, 2});
    set(camera_vertical_fov_rad, camera, {1.25f});
    set(camera_ev100, camera, {11});
    set(material_base_color, material, {0.1f, 0.2f, 0.3f});
    set(material_opacity, material, {0.25f});
    set(material_metallic, material, {0.5f});
    set(material_roughness, material, {0.75f});
    set(material_emission_nits, material, {100, 200, 300});
    set(material_transmission, material, {0.125f});
    set(material_ior, material, {2.5f});
    set(sky_luminance_nits, std::monostate{}, {10, 20, 30});
    scene.apply_animations(0);

    EXPECT_EQ(the_node().transform.translation, glm::vec3(1, 2, 3));
    EXPECT_EQ(the_node().transform.rotation, glm::quat(0, 0, 1, 0));
    EXPECT_EQ(the_node().transform.scale, glm::vec3(4, 5, 6));
    EXPECT_FALSE(the_node().visible);
    EXPECT_EQ(the_node().light->intensity, glm::vec3(7, 8, 9));
    EXPECT_EQ(the_node().light->inner_rad, 0.2f);
    EXPECT_EQ(the_node().light->outer_rad, 0.3f);
    EXPECT_EQ(the_node().light->radius_m, 0.4f);
    EXPECT_EQ(the_node().light->direction, glm::vec3(0, 1, 0));
    const Camera& view = *scene.cameras().find(camera);
    EXPECT_EQ(view.position, glm::vec3(1));
    EXPECT_EQ(view.target, glm::vec3(2));
    EXPECT_EQ(view.vertical_fov_rad, 1.25f);
    EXPECT_EQ(view.ev100(), 11.0f);
    const Material& surface = *scene.materials().find(material);
    EXPECT_EQ(surface.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(surface.opacity, 0.25f);
    EXPECT_EQ(surface.metallic, 0.5f);
    EXPECT_EQ(surface.roughness, 0.75f);
    EXPECT_EQ(surface.emission_nits, glm::vec3(100, 200, 300));
    EXPECT_EQ(surface.transmission, 0.125f);
    EXPECT_EQ(surface.ior, 2.5f);
    EXPECT_EQ(scene.sky().luminance_nits, glm::vec3(10, 20, 30));
}

TEST_F(Animated, ApplyingTheSameTimeAgainLeavesNoChange) {
    using enum AnimatedProperty;
    set(node_translation, node, {1, 2, 3});
    set(light_intensity, node, {7, 8, 9});
    set(camera_ev100, camera, {11});
    set(material_roughness, material, {0.75f});
    set(sky_luminance_nits, std::monostate{}, {10, 20, 30});
    const std::uint64_t before = scene.journal_end();
    scene.apply_animations(0);
    EXPECT_EQ(scene.journal_end(), before + 5);
    scene.apply_animations(0);
    EXPECT_EQ(scene.journal_end(), before + 5);
}

TEST_F(Animated, StepHoldsTheEarlierKey) {
    animate(AnimatedProperty::camera_ev100, camera, Interpolation::step, {1, 2, 4}, {10, 20, 40});
    for (const auto& [time, expected] : {std::pair{0.0, 10.0f},
                                         {1.0, 10.0f},
                                         {1.999, 10.0f},
                                         {2.0, 20.0f},
                                         {3.9, 20.0f},
                                         {4.0, 40.0f},
                                         {9.0, 40.0f}}) {
        scene.apply_animations(time);
        EXPECT_EQ(scene.cameras().find(camera)->ev100(), expected) << "at " << time << " s";
    }
}

TEST_F(Animated, LinearMixesKeysAndHoldsTheEnds) {
    animate(AnimatedProperty::node_translation, node, Interpolation::linear, {1, 3}, {0, 0, 0, 10, 20, 30});
    for (const auto& [time, expected] :
         {std::pair{-5.0, 0.0f}, {1.0, 0.0f}, {1.5, 2.5f}, {2.0, 5.0f}, {3.0, 10.0f}, {99.0, 10.0f}}) {
        scene.apply_animations(time);
        EXPECT_NEAR(glm::length(the_node().transform.translation - glm::vec3(1, 2, 3) * expected), 0, 1e-5) << time;
    }
    EXPECT_EQ(scene.animation_duration_s(), 3.0);
}

TEST_F(Animated, CubicIsTheHermiteSplineOfGltf) {
    // x(t) = t³ on [0, 2]: values 0 and 8, slopes 0 and 12, is reproduced exactly.
    animate(AnimatedProperty::camera_ev100, camera, Interpolation::cubic, {0, 2}, {0, 0, 0, 12, 8, 0});
    for (const double time : {0.0, 0.3, 1.0, 1.7, 2.0}) {
        scene.apply_animations(time);
        EXPECT_NEAR(scene.cameras().find(camera)->ev100(), time * time * time, 1e-5) << time;
    }
}

TEST_F(Animated, RotationsInterpolateAtConstantSpeedTheShortWay) {
    const glm::quat from = rotation_from_euler_deg({0, 0, 0}), to = -rotation_from_euler_deg({0, 90, 0});
    animate(AnimatedProperty::node_rotation, node, Interpolation::linear, {0, 1},
            {from.x, from.y, from.z, from.w, to.x, to.y, to.z, to.w});
    for (const float time : {0.0f, 0.25f, 0.5f, 1.0f}) {
        scene.apply_animations(time);
        const glm::quat expected = rotation_from_euler_deg({0, 90 * time, 0});
        EXPECT_NEAR(std::abs(glm::dot(the_node().transform.rotation, expected)), 1, 1e-6) << time;
    }
}

TEST_F(Animated, CubicRotationsStayUnitLength) {
    const float half = std::sqrt(0.5f);
    animate(AnimatedProperty::node_rotation, node, Interpolation::cubic, {0, 1},
            {0, 0, 0, 0, 0, 0, 0, 1, 0, 3, 0, 0, 0, 0, 0, 0, 0, half, 0, half, 0, 0, 0, 0});
    scene.apply_animations(0.4);
    EXPECT_NEAR(glm::length(the_node().transform.rotation), 1, 1e-6);
}

TEST_F(Animated, OvershootComesBackIntoThePhysicalRange) {
    using enum AnimatedProperty;
    set(material_roughness, material, {-0.5f});
    set(material_ior, material, {0.5f});
    set(light_intensity, node, {-1, 5, -1});
    set(light_outer_rad, node, {0.0f});
    scene.apply_animations(0);
    EXPECT_EQ(scene.materials().find(material)->roughness, 0.0f);
    EXPECT_EQ(scene.materials().find(material)->ior, 1.0f);
    EXPECT_EQ(the_node().light->intensity, glm::vec3(0, 5, 0));
    EXPECT_EQ(the_node().light->outer_rad, the_node().light->inner_rad);
}

TEST_F(Animated, IncompleteChannelsAndRemovedTargetsAreLeftAlone) {
    using enum AnimatedProperty;
    animate(node_translation, node, Interpolation::linear, {0, 1}, {1, 2, 3});
    animate(node_translation, node, Interpolation::linear, {}, {});
    const NodeId gone = scene.add_node({});
    animate(node_translation, gone, Interpolation::linear, {0}, {1, 2, 3});
    scene.remove(gone);
    const std::uint64_t before = scene.journal_end();
    scene.apply_animations(0.5);
    EXPECT_EQ(scene.journal_end(), before);
}

}  // namespace
}  // namespace heliodon
