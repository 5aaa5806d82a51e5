#include <gtest/gtest.h>

#include <numbers>

#include "import/glb_builder.h"

namespace heliodon {
namespace {

using tests::first;
using tests::GlbBuilder;
using tests::Json;

struct SceneFile {
    GlbBuilder builder;
    Scene scene;
    SceneFile() { builder.add_square(); }
    void load() {
        std::string error;
        ASSERT_TRUE(builder.load(scene, &error)) << error;
    }
    const Node& node(std::string_view name) const { return *scene.nodes().find(scene.find_node(name)); }
};

TEST(GltfScene, TransformsComposeDownTheTree) {
    SceneFile file;
    const double half = std::numbers::sqrt2 / 2;
    file.builder.json["nodes"] = {{{"name", "parent"},
                                   {"translation", {1, 2, 3}},
                                   {"rotation", {0, 0, half, half}},
                                   {"scale", {2, 2, 2}},
                                   {"children", {1}}},
                                  {{"name", "child"}, {"mesh", 0}, {"translation", {1, 0, 0}}}};
    file.load();
    const glm::vec3 origin(file.scene.world_matrix(file.scene.find_node("child"))[3]);
    EXPECT_NEAR(origin.x, 1, 1e-6);
    EXPECT_NEAR(origin.y, 4, 1e-6);
    EXPECT_NEAR(origin.z, 3, 1e-6);
    EXPECT_EQ(file.node("child").parts.size(), 1u);
}

TEST(GltfScene, MatricesWithoutShearBecomeTransformsAndOthersStayMatrices) {
    SceneFile file;
    file.builder.json["nodes"] = {{{"name", "turned"}, {"matrix", {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, -4, 0, 5, 6, 7, 1}}},
                                  {{"name", "sheared"}, {"matrix", {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}};
    file.builder.json["scenes"][0]["nodes"] = {0, 1};
    file.load();
    EXPECT_FALSE(file.node("turned").matrix);
    const glm::mat4 expected(0, 2, 0, 0, -3, 0, 0, 0, 0, 0, -4, 0, 5, 6, 7, 1);
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) EXPECT_NEAR(file.node("turned").local_matrix()[c][r], expected[c][r], 1e-5);
    EXPECT_TRUE(file.node("sheared").matrix);
    EXPECT_EQ(file.node("sheared").local_matrix()[1][0], 1.0f);
}

TEST(GltfScene, OnlyTheDefaultSceneIsRead) {
    SceneFile file;
    file.builder.json["nodes"] = {{{"name", "a"}}, {{"name", "b"}}};
    file.builder.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    file.builder.json["scene"] = 1;
    file.load();
    EXPECT_FALSE(file.scene.find_node("a"));
    EXPECT_TRUE(file.scene.find_node("b"));
}

TEST(GltfScene, WithoutScenesEveryRootIsRead) {
    SceneFile file;
    file.builder.json.erase("scene");
    file.builder.json.erase("scenes");
    file.builder.json["nodes"] = {{{"name", "a"}, {"children", {1}}}, {{"name", "b"}}, {{"name", "c"}}};
    file.load();
    EXPECT_EQ(file.scene.nodes().size(), 4u) << "the model's own root and the three";
}

TEST(GltfScene, CamerasStandAtTheirNodes) {
    SceneFile file;
    file.builder.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}}}};
    file.builder.json["nodes"] = {
        {{"mesh", 0}}, {{"name", "eye"}, {"camera", 0}, {"translation", {0.5, 0.5, 4}}}, {{"camera", 1}}};
    file.builder.json["scenes"][0]["nodes"] = {0, 1, 2};
    file.load();
    ASSERT_EQ(file.scene.cameras().size(), 1u);
    const Camera& camera = first(file.scene.cameras());
    EXPECT_EQ(camera.name, "eye");
    EXPECT_FLOAT_EQ(camera.vertical_fov_rad, 0.8f);
    EXPECT_EQ(camera.position, glm::vec3(0.5f, 0.5f, 4));
    EXPECT_LT(glm::distance(camera.target, glm::vec3(0.5f, 0.5f, 0)), 1e-5f) << "it orbits what it looks at";
    EXPECT_TRUE(file.builder.warned("orthographic"));
}

TEST(GltfScene, PunctualLightsAreInCandelaAndLux) {
    SceneFile file;
    file.builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 100}, {"color", {1, 0.5, 0.25}}, {"range", 8}},
        {{"type", "spot"}, {"intensity", 20}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.6}}}},
        {{"type", "directional"}, {"intensity", 90000}}};
    file.builder.json["nodes"] = {{{"name", "point"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                                  {{"name", "spot"}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}},
                                  {{"name", "sun"}, {"extensions", {{"KHR_lights_punctual", {{"light", 2}}}}}}};
    file.builder.json["scenes"][0]["nodes"] = {0, 1, 2};
    file.load();
    EXPECT_EQ(file.node("point").light->intensity, glm::vec3(100, 50, 25));
    EXPECT_EQ(file.node("point").light->range_m, 8.0f);
    EXPECT_EQ(file.node("spot").light->type, LightType::spot);
    EXPECT_FLOAT_EQ(file.node("spot").light->inner_rad, 0.1f);
    EXPECT_FLOAT_EQ(file.node("spot").light->outer_rad, 0.6f);
    EXPECT_EQ(file.node("sun").light->type, LightType::directional);
    EXPECT_EQ(file.node("sun").light->intensity, glm::vec3(90000));
    EXPECT_EQ(file.node("sun").light->direction, glm::vec3(0, 0, -1));
}

TEST(GltfScene, AnimationsDriveNodes) {
    SceneFile file;
    GlbBuilder& builder = file.builder;
    const std::size_t times = builder.add_accessor<float>({0, 2}, "SCALAR");
    const std::size_t moves = builder.add_accessor<float>({0, 0, 0, 4, 0, 0}, "VEC3");
    const std::size_t turns = builder.add_accessor<std::int16_t>({0, 0, 0, 32767, 0, 32767, 0, 0}, "VEC4", true);
    const std::size_t grows =
        builder.add_accessor<float>({0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 2, 2, 2, 0, 0, 0}, "VEC3");
    builder.json["nodes"][0]["name"] = "square";
    builder.json["animations"] = {{{"name", "dance"},
                                   {"samplers",
                                    {{{"input", times}, {"output", moves}},
                                     {{"input", times}, {"output", turns}, {"interpolation", "STEP"}},
                                     {{"input", times}, {"output", grows}, {"interpolation", "CUBICSPLINE"}}}},
                                   {"channels",
                                    {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
                                     {{"sampler", 1}, {"target", {{"node", 0}, {"path", "rotation"}}}},
                                     {{"sampler", 2}, {"target", {{"node", 0}, {"path", "scale"}}}},
                                     {{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
                                     {{"sampler", 0}, {"target", {{"path", "pointer"}}}}}}}};
    file.load();
    const Animation& animation = first(file.scene.animations());
    EXPECT_EQ(animation.name, "dance");
    ASSERT_EQ(animation.channels.size(), 3u);
    EXPECT_EQ(animation.channels[1].interpolation, Interpolation::step);
    EXPECT_EQ(animation.channels[1].values, (std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0}));
    EXPECT_EQ(animation.channels[2].values.size(), 18u);
    EXPECT_EQ(std::get<NodeId>(animation.channels[0].target), file.scene.find_node("square"));
    file.scene.apply_animations(1.0);
    EXPECT_NEAR(file.node("square").transform.translation.x, 2, 1e-6);
    EXPECT_NEAR(file.node("square").transform.scale.y, 1.5, 1e-6) << "half way between flat tangents";
    EXPECT_TRUE(builder.warned("morph weights"));
    EXPECT_TRUE(builder.warned("anything but"));
}

TEST(GltfScene, SkinsMorphTargetsAndUnknownExtensionsAreIgnoredWithOneMessageEach) {
    SceneFile file;
    GlbBuilder& builder = file.builder;
    builder.json["skins"] = {{{"joints", {0}}}};
    builder.json["nodes"][0]["skin"] = 0;
    builder.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
    builder.json["extensionsUsed"] = {"KHR_lights_punctual", "ACME_glitter", "ACME_sparkle"};
    file.load();
    EXPECT_EQ(builder.warnings.size(), 3u);
    EXPECT_TRUE(builder.warned("skins"));
    EXPECT_TRUE(builder.warned("morph targets"));
    EXPECT_TRUE(builder.warned("ACME_glitter, ACME_sparkle"));
}

TEST(GltfScene, DeepTreesAreRead) {
    SceneFile file;
    constexpr int depth = 20000;
    Json nodes = Json::array();
    for (int i = 0; i < depth; ++i) nodes.push_back(i + 1 < depth ? Json{{"children", {i + 1}}} : Json{{"mesh", 0}});
    file.builder.json["nodes"] = nodes;
    file.load();
    EXPECT_EQ(file.scene.nodes().size(), std::size_t(depth) + 1);
}

}  // namespace
}  // namespace heliodon
