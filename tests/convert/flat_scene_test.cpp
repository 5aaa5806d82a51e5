#include "convert/flat_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <random>
#include <tuple>

#include "shading/luminaire_shape.h"

namespace heliodon::convert {
namespace {

Geometry triangle() {
    Geometry geometry;
    geometry.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    geometry.mesh.indices = {0, 1, 2};
    geometry.bounds = geometry.mesh.bounds();
    return geometry;
}

Node node_with(std::string name, std::vector<Part> parts, glm::vec3 translation = {}, std::optional<Light> light = {}) {
    Node node;
    node.name = std::move(name);
    node.parts = std::move(parts);
    node.transform.translation = translation;
    node.light = light;
    return node;
}

Light candela(float value) {
    Light light;
    light.intensity = glm::vec3(value);
    return light;
}

struct Small : testing::Test {
    Scene scene;
    GeometryId geometry = scene.add_geometry(triangle());
    MaterialId material = scene.add_material({});
    NodeId parent, child, lamp;
    FlatScene flat;

    void SetUp() override {
        parent = scene.add_node(node_with("parent", {{geometry, material}}));
        child = scene.add_node(node_with("child", {{geometry, material}}, {1, 0, 0}), parent);
        lamp = scene.add_node(node_with("lamp", {}, {0, 2, 0}, candela(3)), parent);
        EXPECT_TRUE(flat.update(scene).everything);
    }
};

TEST_F(Small, nothing_changes_when_nothing_was_edited) { EXPECT_FALSE(flat.update(scene).any()); }

TEST_F(Small, moving_a_leaf_touches_its_instance_alone) {
    Transform transform;
    transform.translation = {5, 0, 0};
    ASSERT_TRUE(scene.set_transform(child, transform));
    const FlatChanges changes = flat.update(scene);
    EXPECT_EQ(changes.instances.size(), 1u);
    EXPECT_TRUE(changes.geometries.empty() && changes.materials.empty() && changes.lights.empty());
    EXPECT_FLOAT_EQ(flat.instances()[changes.instances[0]].object_to_world[3].x, 5.0f);
}

TEST_F(Small, moving_a_parent_moves_all_below_it_and_their_lights) {
    Transform transform;
    transform.translation = {0, 0, 7};
    ASSERT_TRUE(scene.set_transform(parent, transform));
    const FlatChanges changes = flat.update(scene);
    EXPECT_EQ(changes.instances.size(), 2u);
    ASSERT_EQ(changes.lights.size(), 1u);
    EXPECT_EQ(flat.lights()[changes.lights[0]].position, glm::vec3(0, 2, 7));
}

TEST_F(Small, editing_a_material_touches_that_material_alone) {
    Material red = *scene.materials().find(material);
    red.base_color = {1, 0, 0};
    ASSERT_TRUE(scene.set_material(material, red));
    const FlatChanges changes = flat.update(scene);
    ASSERT_EQ(changes.materials, std::vector<std::uint32_t>{material.index + 1});
    EXPECT_TRUE(changes.instances.empty());
    EXPECT_EQ(flat.materials()[changes.materials[0]].base_color, glm::vec3(1, 0, 0));
}

TEST_F(Small, hiding_a_parent_hides_instances_and_lights_below) {
    ASSERT_TRUE(scene.set_visible(parent, false));
    flat.update(scene);
    EXPECT_TRUE(flat.bounds().empty());
    EXPECT_EQ(flat.lights()[0].type, shading::light_type_none);
    ASSERT_TRUE(scene.set_visible(parent, true));
    flat.update(scene);
    EXPECT_FALSE(flat.bounds().empty());
    EXPECT_EQ(flat.lights()[0].type, shading::light_type_point);
}

TEST_F(Small, removing_a_geometry_hides_what_used_it) {
    ASSERT_TRUE(scene.remove(geometry));
    const FlatChanges changes = flat.update(scene);
    EXPECT_EQ(changes.geometries.size(), 1u);
    EXPECT_EQ(flat.geometries()[geometry.index], nullptr);
    EXPECT_TRUE(flat.bounds().empty());
}

TEST_F(Small, removing_a_material_falls_back_to_the_default_one) {
    ASSERT_TRUE(scene.remove(material));
    flat.update(scene);
    for (const auto& instance : flat.instances()) EXPECT_EQ(instance.material, 0u);
}

TEST_F(Small, a_node_scaled_to_nothing_is_not_drawn) {
    Transform flat_transform;
    flat_transform.scale = {1, 0, 1};
    ASSERT_TRUE(scene.set_transform(child, flat_transform));
    const FlatChanges changes = flat.update(scene);
    EXPECT_EQ(flat.instances()[changes.instances[0]].flags, 0u);
}

TEST_F(Small, a_mirrored_node_says_so) {
    Transform mirror;
    mirror.scale = {-1, 1, 1};
    ASSERT_TRUE(scene.set_transform(child, mirror));
    const FlatChanges changes = flat.update(scene);
    EXPECT_EQ(flat.instances()[changes.instances[0]].determinant_sign, -1.0f);
}

TEST_F(Small, slots_of_removed_nodes_are_used_again) {
    const auto instances = flat.instances().size();
    for (int i = 0; i < 10; ++i) {
        ASSERT_TRUE(scene.remove(child));
        child = scene.add_node(node_with("child", {{geometry, material}}), parent);
        flat.update(scene);
    }
    EXPECT_EQ(flat.instances().size(), instances);
}

TEST(FlatScene, a_texture_size_limit_skips_the_levels_above_it) {
    Scene scene;
    Texture texture;
    texture.width = 1024;
    texture.height = 256;
    for (int size = 1024; size >= 1; size /= 2) texture.levels.emplace_back(4);
    scene.add_texture(texture);
    FlatScene flat;
    flat.update(scene);
    EXPECT_EQ(flat.texture_first_levels()[0], 0u);
    ConvertSettings settings;
    settings.texture_size_limit = 300;
    scene.set_convert_settings(settings);
    EXPECT_TRUE(flat.update(scene).everything);
    EXPECT_EQ(flat.texture_first_levels()[0], 2u);
}

/// What a table draws, apart from where in the table it stands.
std::vector<std::tuple<std::uint32_t, std::uint32_t, float, float>> drawn(const FlatScene& flat) {
    std::vector<std::tuple<std::uint32_t, std::uint32_t, float, float>> result;
    for (const auto& instance : flat.instances())
        if (instance.flags & shading::instance_flag_visible)
            result.emplace_back(instance.geometry, instance.material, instance.object_to_world[3].x, instance.object_to_world[3].y);
    std::sort(result.begin(), result.end());
    return result;
}

TEST(FlatScene, following_the_journal_equals_building_from_scratch_for_any_edits) {
    Scene scene;
    std::mt19937 random(7);
    std::vector<GeometryId> geometries;
    std::vector<MaterialId> materials;
    std::vector<NodeId> nodes;
    for (int i = 0; i < 4; ++i) geometries.push_back(scene.add_geometry(triangle()));
    for (int i = 0; i < 4; ++i) materials.push_back(scene.add_material({}));
    FlatScene followed;
    followed.update(scene);
    const auto any = [&](auto& list) { return list[random() % list.size()]; };
    for (int step = 0; step < 2000; ++step) {
        const auto action = nodes.size() < 3 ? 0 : random() % (nodes.size() < 40 ? 16 : 9);  // growing to some 40 nodes
        Transform transform;
        transform.translation = {float(random() % 100), float(random() % 100), 0};
        switch (action > 8 ? 0 : action) {
            case 0: {
                const auto light = random() % 3 == 0 ? std::optional(candela(1)) : std::nullopt;
                const Node node = node_with("", {{any(geometries), any(materials)}}, transform.translation, light);
                nodes.push_back(scene.add_node(node, nodes.empty() || random() % 2 ? NodeId{} : any(nodes)));
                break;
            }
            case 1: scene.set_transform(any(nodes), transform); break;
            case 2: scene.set_visible(any(nodes), random() % 2); break;
            case 3: scene.set_parts(any(nodes), std::vector<Part>(random() % 4, {any(geometries), any(materials)})); break;
            case 4: scene.set_light(any(nodes), random() % 2 ? std::optional(candela(2)) : std::nullopt); break;
            case 5: scene.set_parent(any(nodes), any(nodes)); break;
            case 6: scene.remove(any(nodes)); break;
            case 7: {
                const std::size_t k = random() % materials.size();
                scene.remove(materials[k]);
                materials[k] = scene.add_material({});
                break;
            }
            case 8: {
                const std::size_t k = random() % geometries.size();
                scene.remove(geometries[k]);
                geometries[k] = scene.add_geometry(triangle());
                break;
            }
        }
        std::erase_if(nodes, [&](NodeId id) { return !scene.nodes().contains(id); });
        if (step % 5) continue;
        followed.update(scene);
        FlatScene fresh;
        fresh.update(scene);
        ASSERT_EQ(drawn(followed), drawn(fresh)) << "after step " << step;
        const auto lit = [](const FlatScene& flat) {
            return std::count_if(flat.lights().begin(), flat.lights().end(),
                                 [](const auto& light) { return light.type != shading::light_type_none; });
        };
        ASSERT_EQ(lit(followed), lit(fresh)) << "after step " << step;
    }
}

Light luminaire_light(double candela, OpeningShape shape = OpeningShape::box) {
    auto luminaire = std::make_shared<Luminaire>();
    luminaire->web = {.polar_rad = {0, 1.5}, .azimuth_rad = {0}, .candela = {candela, candela / 2}};
    luminaire->opening = {shape, {0.6f, 0.1f, 0.2f}};
    integrate(*luminaire);
    Light light{.type = LightType::luminaire, .intensity = glm::vec3(static_cast<float>(candela))};
    light.luminaire = std::move(luminaire);
    return light;
}

TEST(FlatLuminaires, LightsOfOneFileShareATableAndOthersAreAppended) {
    Scene scene;
    const Light shared = luminaire_light(8);
    const NodeId first = scene.add_node(node_with("first", {}, {1, 0, 0}, shared));
    scene.add_node(node_with("second", {}, {2, 0, 0}, shared));
    FlatScene flat;
    EXPECT_TRUE(flat.update(scene).everything);
    ASSERT_EQ(flat.luminaire_table().size(), 7u);  // two counts, two angles, one plane, two values
    EXPECT_EQ(flat.luminaire_table()[5], 1.0f);
    EXPECT_EQ(flat.luminaire_table()[6], 0.5f);
    EXPECT_EQ(flat.lights()[0].table, flat.lights()[1].table);
    EXPECT_NEAR(flat.lights()[0].flux_factor * 8, shared.luminaire->flux_lm, 1e-5);

    scene.set_light(first, luminaire_light(3));
    const FlatChanges changes = flat.update(scene);
    EXPECT_TRUE(changes.luminaires && !changes.everything);
    EXPECT_EQ(flat.luminaire_table().size(), 14u);
    EXPECT_NE(flat.lights()[0].table, flat.lights()[1].table);
    scene.set_transform(first, {.translation = {0, 1, 0}});
    EXPECT_FALSE(flat.update(scene).luminaires);
}

TEST(FlatLuminaires, AnOpeningsAxesAreThoseOfItsTableAndFacesWeighByWhatTheySend) {
    Scene scene;
    scene.add_node(node_with("box", {}, {}, luminaire_light(8)));
    scene.add_node(node_with("tube", {}, {}, luminaire_light(8, OpeningShape::cylinder_x)));
    Node mirrored = node_with("mirrored", {}, {}, luminaire_light(8));
    mirrored.transform.scale = {-1, 1, 1};
    scene.add_node(mirrored);
    FlatScene flat;
    (void)flat.update(scene);
    const shading::LightData& box = flat.lights()[0];
    EXPECT_EQ(box.axis, glm::vec3(0, -1, 0));
    EXPECT_EQ(box.tangent, glm::vec3(1, 0, 0));
    EXPECT_EQ(box.half_extent, glm::vec3(0.3f, 0.1f, 0.05f));  // C0, C90, nadir
    EXPECT_EQ(box.opening, shading::opening_box);
    const auto weight = [&](std::uint32_t face) { return shading::opening_face_weight(box.face_weights, face); };
    EXPECT_EQ(weight(4), 31.0f);  // downwards
    EXPECT_EQ(weight(5), 1.0f);   // nothing goes up
    EXPECT_EQ(weight(0), weight(1));
    EXPECT_GT(weight(2), weight(0));  // the longer sides
    EXPECT_EQ(flat.lights()[1].opening, shading::opening_cylinder_x);
    EXPECT_EQ(flat.lights()[2].opening, shading::opening_box | shading::opening_mirrored);
}

}  // namespace
}  // namespace heliodon::convert
