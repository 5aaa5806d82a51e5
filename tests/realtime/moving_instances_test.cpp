#include "realtime/moving_instances.h"

#include <gtest/gtest.h>

namespace heliodon::realtime {
namespace {

using Indices = std::vector<std::uint32_t>;

Texture one_texel(std::uint8_t value) {
    Texture texture;
    texture.width = texture.height = 1;
    texture.levels.push_back({value, value, value, 255});
    return texture;
}

struct Surfaces : testing::Test {
    Scene scene;
    TextureId picture = scene.add_texture(one_texel(9)), unused = scene.add_texture(one_texel(9));
    MaterialId plain = scene.add_material({}), textured;
    GeometryId ball = scene.add_shape(Sphere{}), box = scene.add_shape(Box{});
    NodeId parent, child, other, lamp;
    convert::FlatScene flat;
    MovingInstances surfaces;

    NodeId add(Part part, NodeId below = {}) {
        Node node;
        node.parts.push_back(part);
        return scene.add_node(std::move(node), below);
    }
    void SetUp() override {
        Material material;
        material.base_color_texture.texture = picture;
        textured = scene.add_material(material);
        parent = add({ball, plain});
        child = add({box, plain}, parent);
        other = add({ball, textured});
        Node node;
        node.light = Light{};
        node.parts.push_back({box, textured});
        lamp = scene.add_node(std::move(node));
        EXPECT_EQ(follow(), (Indices{0, 1, 2, 3}));
        EXPECT_FALSE(surfaces.moves(0));
    }
    /// The instances that one update changed.
    Indices follow() {
        const std::uint64_t before = surfaces.revision();
        surfaces.follow(flat, flat.update(scene));
        EXPECT_EQ(surfaces.revision() > before, !surfaces.changed_since(before).empty());
        return surfaces.changed_since(before);
    }
};

TEST_F(Surfaces, MovingANodeListsItAndWhatIsBelowIt) {
    ASSERT_TRUE(scene.set_transform(parent, Transform{.translation = {0, 1, 0}}));
    EXPECT_EQ(follow(), (Indices{0, 1}));
    EXPECT_TRUE(surfaces.moves(0) && surfaces.moves(1));
    EXPECT_FALSE(surfaces.moves(2) || surfaces.moves(3));
    EXPECT_EQ(follow(), Indices{});
    ASSERT_TRUE(scene.set_transform(child, Transform{.translation = {0, 1, 0}}));
    EXPECT_EQ(follow(), Indices{1});
    EXPECT_EQ(surfaces.changed_since(surfaces.loaded_revision()), (Indices{0, 1}));
}

TEST_F(Surfaces, LightsCamerasSensorsAndTheSkyAreNone) {
    Light light;
    light.intensity = glm::vec3(7);
    ASSERT_TRUE(scene.set_light(lamp, light));
    Sky sky;
    sky.model = SkyModel::constant;
    sky.luminance_nits = glm::vec3(5);
    scene.set_sky(sky);
    scene.add_camera({});
    scene.add_sensor({});
    EXPECT_EQ(follow(), Indices{});
    ASSERT_TRUE(scene.set_light(lamp, {}));
    EXPECT_EQ(follow(), Indices{});
}

TEST_F(Surfaces, AMaterialChangesWhatItIsOn) {
    Material red;
    red.base_color = {1, 0, 0};
    ASSERT_TRUE(scene.set_material(plain, red));
    EXPECT_EQ(follow(), (Indices{0, 1}));
    ASSERT_TRUE(scene.set_material(plain, red));
    EXPECT_EQ(follow(), Indices{});
    scene.add_material(red);
    EXPECT_EQ(follow(), Indices{});
}

TEST_F(Surfaces, ATextureChangesTheMaterialsThatUseIt) {
    ASSERT_TRUE(scene.set_texture(picture, one_texel(200)));
    EXPECT_EQ(follow(), (Indices{2, 3}));
    ASSERT_TRUE(scene.set_texture(unused, one_texel(200)));
    EXPECT_EQ(follow(), Indices{});
    ASSERT_TRUE(scene.remove(picture));
    EXPECT_EQ(follow(), (Indices{2, 3}));
}

TEST_F(Surfaces, AGeometryChangesItsInstances) {
    Geometry geometry;
    geometry.mesh = tessellate(Box{{0, 0, 0}, {2, 2, 2}}, 4);
    ASSERT_TRUE(scene.set_geometry(box, geometry));
    EXPECT_EQ(follow(), (Indices{1, 3}));
    ASSERT_TRUE(scene.remove(box));
    EXPECT_EQ(follow(), (Indices{1, 3}));
    scene.add_shape(Sphere{});
    EXPECT_EQ(follow(), Indices{});
}

TEST_F(Surfaces, NodesThatComeGoAndHideAreListed) {
    const NodeId added = add({ball, plain});
    EXPECT_EQ(follow(), Indices{4});
    ASSERT_TRUE(scene.set_visible(other, false));
    EXPECT_EQ(follow(), Indices{2});
    ASSERT_TRUE(scene.set_transform(other, Transform{.translation = {3, 0, 0}}));
    EXPECT_EQ(follow(), Indices{});  // nobody sees it move
    ASSERT_TRUE(scene.remove(added));
    EXPECT_EQ(follow(), Indices{4});
    ASSERT_TRUE(scene.set_visible(other, true));
    EXPECT_EQ(follow(), Indices{2});
}

}  // namespace
}  // namespace heliodon::realtime
