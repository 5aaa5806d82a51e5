#include "scene/scene.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace heliodon {
namespace {

using Table = Change::Table;

std::vector<Change> changes(const Scene& scene, std::uint64_t since) {
    std::vector<Change> result;
    EXPECT_TRUE(scene.changes_since(since, [&](const Change& change) { result.push_back(change); }));
    return result;
}

/// Runs `edit` and expects exactly one change of it.
template <class Edit>
void expect_one_change(Scene& scene, Table table, std::uint8_t aspects, std::uint32_t index, Edit&& edit) {
    const std::uint64_t before = scene.journal_end();
    edit();
    const std::vector<Change> made = changes(scene, before);
    ASSERT_EQ(made.size(), 1u);
    EXPECT_EQ(made[0].table, table);
    EXPECT_EQ(made[0].aspects, aspects);
    EXPECT_EQ(made[0].index, index);
}

TEST(Scene, HandlesOfRemovedObjectsStayInvalidWhenTheirSlotIsUsedAgain) {
    Scene scene;
    const MaterialId first = scene.add_material({.name = "first"});
    const MaterialId other = scene.add_material({.name = "other"});
    EXPECT_TRUE(scene.remove(first));
    const MaterialId second = scene.add_material({.name = "second"});
    EXPECT_EQ(second.index, first.index);
    EXPECT_NE(second, first);
    EXPECT_EQ(scene.materials().find(first), nullptr);
    EXPECT_FALSE(scene.set_material(first, {}));
    EXPECT_FALSE(scene.remove(first));
    EXPECT_EQ(scene.materials().find(second)->name, "second");
    EXPECT_EQ(scene.materials().find(other)->name, "other");
    EXPECT_EQ(scene.materials().size(), 2u);
    EXPECT_FALSE(MaterialId{});
}

TEST(Scene, EveryEditOfANodeLeavesOneChange) {
    Scene scene;
    const NodeId parent = scene.add_node({.name = "parent"});
    NodeId id;
    expect_one_change(scene, Table::node, Change::added, 1, [&] { id = scene.add_node({.name = "node"}); });
    expect_one_change(scene, Table::node, Change::transform, 1, [&] {
        scene.set_transform(id, {.translation = {1, 0, 0}});
    });
    expect_one_change(scene, Table::node, Change::transform, 1, [&] { scene.set_matrix(id, glm::mat4(2.0f)); });
    expect_one_change(scene, Table::node, Change::parts, 1, [&] { scene.set_parts(id, {Part{}}); });
    expect_one_change(scene, Table::node, Change::light, 1, [&] { scene.set_light(id, Light{}); });
    expect_one_change(scene, Table::node, Change::visibility, 1, [&] { scene.set_visible(id, false); });
    expect_one_change(scene, Table::node, Change::value, 1, [&] { scene.set_name(id, "renamed"); });
    expect_one_change(scene, Table::node, Change::hierarchy, 1, [&] { scene.set_parent(id, parent); });
    expect_one_change(scene, Table::node, Change::removed, 1, [&] { scene.remove(id); });
}

TEST(Scene, EveryEditOfATableLeavesOneChange) {
    Scene scene;
    const auto check = [&](Table table, auto add, auto set) {
        decltype(add()) id;
        expect_one_change(scene, table, Change::added, 0, [&] { id = add(); });
        if constexpr (!std::is_same_v<decltype(set), std::nullptr_t>)
            expect_one_change(scene, table, Change::value, 0, [&] { EXPECT_TRUE(set(id)); });
        expect_one_change(scene, table, Change::removed, 0, [&] { EXPECT_TRUE(scene.remove(id)); });
        EXPECT_FALSE(scene.remove(id));
        if constexpr (!std::is_same_v<decltype(set), std::nullptr_t>) {
            EXPECT_FALSE(set(id));
        }
    };
    check(
        Table::geometry, [&] { return scene.add_shape(Sphere{}); },
        [&](GeometryId id) { return scene.set_geometry(id, {}); });
    check(
        Table::texture, [&] { return scene.add_texture({}); }, [&](TextureId id) { return scene.set_texture(id, {}); });
    check(
        Table::material, [&] { return scene.add_material({}); },
        [&](MaterialId id) { return scene.set_material(id, {}); });
    check(
        Table::camera, [&] { return scene.add_camera({}); }, [&](CameraId id) { return scene.set_camera(id, {}); });
    check(
        Table::sensor, [&] { return scene.add_sensor({}); }, [&](SensorId id) { return scene.set_sensor(id, {}); });
    check(
        Table::animation, [&] { return scene.add_animation({}); }, nullptr);
    expect_one_change(scene, Table::sky, Change::value, 0, [&] { scene.set_sky({}); });
    expect_one_change(scene, Table::settings, Change::value, 0, [&] { scene.set_convert_settings({}); });
    expect_one_change(scene, Table::settings, Change::value, 0, [&] { scene.set_render_settings({}); });
}

TEST(Scene, EditsOfStaleHandlesChangeNothing) {
    Scene scene;
    const NodeId id = scene.add_node({});
    scene.remove(id);
    const std::uint64_t before = scene.journal_end();
    EXPECT_FALSE(scene.set_transform(id, {}));
    EXPECT_FALSE(scene.set_matrix(id, glm::mat4(1)));
    EXPECT_FALSE(scene.set_parts(id, {}));
    EXPECT_FALSE(scene.set_light(id, {}));
    EXPECT_FALSE(scene.set_visible(id, false));
    EXPECT_FALSE(scene.set_name(id, ""));
    EXPECT_FALSE(scene.set_parent(id, {}));
    EXPECT_FALSE(scene.add_node({}, id));
    EXPECT_FALSE(scene.world_visible(id));
    EXPECT_EQ(scene.journal_end(), before);
}

TEST(Scene, SettingWhatIsAlreadySoLeavesNoChange) {
    Scene scene;
    const NodeId id = scene.add_node({});
    scene.set_transform(id, {.translation = {1, 2, 3}});
    const std::uint64_t before = scene.journal_end();
    EXPECT_TRUE(scene.set_transform(id, {.translation = {1, 2, 3}}));
    EXPECT_TRUE(scene.set_visible(id, true));
    EXPECT_TRUE(scene.set_parent(id, {}));
    EXPECT_EQ(scene.journal_end(), before);
}

TEST(Scene, JournalForgetsTheOldestChangesAndSaysSo) {
    Scene scene;
    for (int i = 0; i < (1 << 20) + 10; ++i) scene.set_sky({});
    EXPECT_EQ(scene.journal_end(), (1u << 20) + 10u);
    int visited = 0;
    EXPECT_FALSE(scene.changes_since(0, [&](const Change&) { ++visited; }));
    EXPECT_FALSE(scene.changes_since(9, [&](const Change&) { ++visited; }));
    EXPECT_EQ(visited, 0);
    EXPECT_TRUE(scene.changes_since(10, [&](const Change&) { ++visited; }));
    EXPECT_EQ(visited, 1 << 20);
}

TEST(Scene, RemovingANodeRemovesWhatIsBelowIt) {
    Scene scene;
    const NodeId root = scene.add_node({.name = "root"});
    const NodeId middle = scene.add_node({.name = "middle"}, root);
    const NodeId leaf = scene.add_node({.name = "leaf"}, middle);
    const NodeId sibling = scene.add_node({.name = "sibling"}, root);
    const std::uint64_t before = scene.journal_end();
    EXPECT_TRUE(scene.remove(middle));
    EXPECT_FALSE(scene.nodes().contains(middle));
    EXPECT_FALSE(scene.nodes().contains(leaf));
    EXPECT_EQ(changes(scene, before).size(), 2u);
    ASSERT_EQ(scene.nodes().find(root)->children().size(), 1u);
    EXPECT_EQ(scene.nodes().find(root)->children()[0], sibling);
    EXPECT_TRUE(scene.remove(root));
    EXPECT_EQ(scene.nodes().size(), 0u);
    EXPECT_TRUE(scene.roots().empty());
}

TEST(Scene, RefusesToMakeANodeItsOwnAncestor) {
    Scene scene;
    const NodeId a = scene.add_node({});
    const NodeId b = scene.add_node({}, a);
    const NodeId c = scene.add_node({}, b);
    EXPECT_FALSE(scene.set_parent(a, a));
    EXPECT_FALSE(scene.set_parent(a, c));
    EXPECT_TRUE(scene.set_parent(c, a));
    EXPECT_TRUE(scene.set_parent(b, c));
    EXPECT_EQ(scene.nodes().find(b)->parent(), c);
    EXPECT_TRUE(scene.set_parent(c, {}));
    EXPECT_EQ(scene.roots().size(), 2u);
}

TEST(Scene, AHundredThousandNestedNodesNeedNoDeepCallStack) {
    Scene scene;
    const GeometryId geometry = scene.add_shape(Box{});
    NodeId id;
    for (int i = 0; i < 100'000; ++i) id = scene.add_node({}, id);
    scene.set_parts(id, {Part{geometry, {}}});
    EXPECT_EQ(scene.bounds().max, glm::vec3(1));
    EXPECT_TRUE(scene.remove(scene.roots()[0]));
    EXPECT_EQ(scene.nodes().size(), 0u);
}

TEST(Scene, WorldMatrixComposesParentsAndMatrices) {
    Scene scene;
    const NodeId parent = scene.add_node({.transform = {.translation = {1, 0, 0}, .scale = glm::vec3(2)}});
    const NodeId child = scene.add_node({.transform = {.translation = {0, 3, 0}}}, parent);
    EXPECT_EQ(glm::vec3(scene.world_matrix(child)[3]), glm::vec3(1, 6, 0));
    scene.set_matrix(parent, glm::mat4(1.0f));
    EXPECT_EQ(glm::vec3(scene.world_matrix(child)[3]), glm::vec3(0, 3, 0));
    scene.set_transform(parent, {.translation = {5, 0, 0}});
    EXPECT_EQ(glm::vec3(scene.world_matrix(child)[3]), glm::vec3(5, 3, 0));
}

TEST(Scene, RotationIsRxRyRz) {
    const glm::vec3 degrees(30, -50, 110);
    const glm::vec3 r = glm::radians(degrees);
    const glm::mat4 expected = glm::rotate(glm::mat4(1), r.x, {1, 0, 0}) * glm::rotate(glm::mat4(1), r.y, {0, 1, 0}) *
                               glm::rotate(glm::mat4(1), r.z, {0, 0, 1});
    const glm::mat4 actual = Transform{.rotation = rotation_from_euler_deg(degrees)}.matrix();
    for (int column = 0; column < 4; ++column) EXPECT_LT(glm::length(actual[column] - expected[column]), 1e-6f);
}

TEST(Scene, BoundsHoldVisibleGeometryOnly) {
    Scene scene;
    EXPECT_TRUE(scene.bounds().empty());
    const GeometryId box = scene.add_shape(Box{});
    scene.add_node({.transform = {.translation = {10, 0, 0}}, .parts = {{box, {}}}});
    const NodeId hidden = scene.add_node({.visible = false});
    const NodeId below = scene.add_node({.transform = {.translation = {-50, 0, 0}}, .parts = {{box, {}}}}, hidden);
    EXPECT_FALSE(scene.world_visible(below));
    EXPECT_EQ(scene.bounds().min, glm::vec3(10, 0, 0));
    EXPECT_EQ(scene.bounds().max, glm::vec3(11, 1, 1));
    scene.set_visible(hidden, true);
    EXPECT_EQ(scene.bounds().min, glm::vec3(-50, 0, 0));
    scene.remove(box);
    EXPECT_TRUE(scene.bounds().empty()) << "a stale geometry reads as absent";
}

TEST(Scene, FindsByName) {
    Scene scene;
    const NodeId node = scene.add_node({.name = "a"});
    const MaterialId material = scene.add_material({.name = "a"});
    const CameraId camera = scene.add_camera({.name = "a"});
    EXPECT_EQ(scene.find_node("a"), node);
    EXPECT_EQ(scene.find_material("a"), material);
    EXPECT_EQ(scene.find_camera("a"), camera);
    EXPECT_FALSE(scene.find_node("b"));
    scene.set_name(node, "b");
    EXPECT_EQ(scene.find_node("b"), node);
}

TEST(Scene, ANewSegmentCountTessellatesShapesAgain) {
    Scene scene;
    const GeometryId sphere = scene.add_shape(Sphere{}, "ball");
    const std::size_t before = scene.geometries().find(sphere)->mesh.triangle_count();
    const std::uint64_t end = scene.journal_end();
    scene.set_convert_settings({.shape_segments = 16});
    EXPECT_LT(scene.geometries().find(sphere)->mesh.triangle_count(), before);
    EXPECT_EQ(scene.geometries().find(sphere)->name, "ball");
    EXPECT_EQ(changes(scene, end).size(), 2u);
}

}  // namespace
}  // namespace heliodon
