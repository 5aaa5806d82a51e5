// What moves and what is changed is right in the next frame; light of all bounces comes to rest soon.
#include "gi_live.h"
#include "scene/procedural.h"

namespace heliodon::tests {
namespace {

class GiDynamic : public LiveFrames {
protected:
    /// A room with a lamp that glows, a crate and a point light that move.
    void SetUp() override {
        LiveFrames::SetUp();
        const MaterialId white = scene.add_material(lambert(glm::vec3(0.73f)));
        Material glowing = lambert(glm::vec3(0.4f));
        glowing.emission_nits = {30, 25, 20};
        Material copper;  // sends the light ahead
        copper.base_color = {0.6f, 0.2f, 0.1f};
        copper.metallic = 1;
        copper.roughness = 0.4f;
        add_room(scene, {-1, 0, -1}, {1, 2, 1}, white);
        add_shape_node(scene, Quad{{0.2f, 1.9f, -0.3f}, {0.4f, 0, 0}, {0, 0, 0.5f}}, scene.add_material(glowing));
        crate = add_shape_node(scene, Box{{-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f}},
                               scene.add_material(copper));
        light = add_point_light(scene, {0, 1.5f, 0}, glm::vec3(20));
        place(0);
        use_cone_tracing(scene, 32);
        change_settings(scene, [](RenderSettings& settings) { settings.bounces = 1, settings.shadow_map_size = 256; });
        camera.position = {0.1f, 1, 0.95f};
        camera.target = {0, 0.8f, 0};
        camera.vertical_fov_rad = 1.6f;
        camera.ev100_override = 4.0f;
    }
    void place(int step) {
        const float t = static_cast<float>(step);
        place_crate(step);
        scene.set_transform(light, {.translation = {-0.3f + 0.17f * t, 1.5f - 0.1f * t, 0.2f}});
    }
    void place_crate(int step) {
        const float t = static_cast<float>(step);
        scene.set_transform(crate, {.translation = {-0.5f + 0.19f * t, 0.25f + 0.11f * t, -0.2f},
                                    .rotation = rotation_from_euler_deg({10 * t, 25 * t, 0})});
    }
    Scene scene;
    Camera camera;
    NodeId crate, light;
};

TEST_F(GiDynamic, AMovingLightAndAMovingObjectAreRightInTheNextFrame) {
    // Sums are integers and each voxel's light depends on nothing but them: the frames are the same, bit for bit.
    Renderer live = new_renderer();
    std::vector<float> before;
    for (int step = 0; step < 4; ++step) {
        place(step);
        const auto next = frame(live, scene, camera), expected = fresh_frame(scene, camera);
        EXPECT_EQ(difference(next, expected), 0) << step;
        if (step > 0) { EXPECT_GT(difference(next, before), 0.1) << "the check must have something to check"; }
        before = next;
    }
}

TEST_F(GiDynamic, WhatComputeFindsOfSurfacesBesideVoxelizationIsTheHardwaresPictureInTheNextFrame) {
    Node lamp;
    lamp.transform.translation = {-0.6f, 1.2f, 0.5f};
    lamp.light = Light{.type = LightType::point, .intensity = glm::vec3(15), .radius_m = 0.1f};
    scene.add_node(lamp);
    change_settings(scene, [](RenderSettings& s) {
        s.rasterizer = Rasterizer::compute, s.revoxelize = Revoxelize::always;
        s.vct.shadows = true, s.vct.resolution = ConeResolution::half;
    });
    Renderer live = new_renderer();
    frame(live, scene, camera);
    place(2);
    const auto next = frame(live, scene, camera);
    EXPECT_EQ(difference(next, fresh_frame(scene, camera)), 0);
    change_settings(scene, [](RenderSettings& s) { s.rasterizer = Rasterizer::hardware; });
    EXPECT_LT(difference(next, fresh_frame(scene, camera)), 1e-3) << "rounding at edges";
}

TEST_F(GiDynamic, WhatMovesOutAppearsOrVanishesIsRightInTheNextFrame) {
    Renderer live = new_renderer();
    frame(live, scene, camera);
    scene.set_visible(crate, false);
    EXPECT_EQ(difference(frame(live, scene, camera), fresh_frame(scene, camera)), 0);
    scene.set_visible(crate, true);
    EXPECT_EQ(difference(frame(live, scene, camera), fresh_frame(scene, camera)), 0);
    scene.set_transform(crate, {.translation = {0, 3, 0}});  // the scene's bounds change with it
    EXPECT_EQ(difference(frame(live, scene, camera), fresh_frame(scene, camera)), 0);
}

TEST_F(GiDynamic, EverySettingTakesEffectInTheNextFrame) {
    Renderer live = new_renderer();
    std::vector<float> before = frame(live, scene, camera);
    scene.set_sky({.model = SkyModel::constant, .luminance_nits = glm::vec3(5)});
    const std::vector<std::pair<const char*, std::function<void(RenderSettings&)>>> changes{
        {"bounces", [](RenderSettings& s) { s.bounces = 2; }},
        {"voxels", [](RenderSettings& s) { s.voxels = 64; }},
        {"cascades", [](RenderSettings& s) { s.voxels = 32, s.cascades = 2; }},
        {"shadows", [](RenderSettings& s) { s.cascades = 1, s.vct.shadows = true; }},
        {"no shadows", [](RenderSettings& s) { s.vct.shadows = false; }},
        {"diffuse", [](RenderSettings& s) { s.vct.diffuse = false; }},
        {"ao", [](RenderSettings& s) { s.vct.diffuse = true, s.vct.ao = false; }},
        {"cones", [](RenderSettings& s) { s.vct.cones = 18; }},
    };
    Node lamp;
    lamp.transform.translation = {-0.6f, 1.2f, 0.5f};
    lamp.light = Light{.type = LightType::point, .intensity = glm::vec3(15), .radius_m = 0.1f};
    scene.add_node(lamp);
    for (const auto& [name, change] : changes) {
        change_settings(scene, change);
        const auto next = frame(live, scene, camera);
        EXPECT_EQ(difference(next, fresh_frame(scene, camera)), 0) << name;
        EXPECT_GT(difference(next, before), 1e-3) << name;
        before = next;
    }
}

TEST_F(GiDynamic, RevoxelizeOnceLeavesTheVolumeAsItWasUntilItIsToldOtherwise) {
    Renderer live = new_renderer();
    change_settings(scene, [](RenderSettings& s) { s.revoxelize = Revoxelize::once; });
    frame(live, scene, camera);
    const Records at_first = records(live);
    place_crate(2);
    const auto stale = frame(live, scene, camera);
    EXPECT_EQ(records(live), at_first);
    const auto right = fresh_frame(scene, camera);
    EXPECT_GT(difference(stale, right), 0.01);
    change_settings(scene, [](RenderSettings& s) { s.revoxelize = Revoxelize::changed; });
    EXPECT_EQ(difference(frame(live, scene, camera), right), 0);
    EXPECT_NE(records(live), at_first);
}

TEST_F(GiDynamic, RevoxelizeAlwaysGivesTheSamePictureAndVoxelizesEverythingEachFrame) {
    Renderer live = new_renderer(), always = new_renderer();
    for (int step = 0; step < 3; ++step) {
        place(step);
        const auto expected = frame(live, scene, camera);
        change_settings(scene, [](RenderSettings& s) { s.revoxelize = Revoxelize::always; });
        EXPECT_EQ(difference(frame(always, scene, camera), expected), 0) << step;
        change_settings(scene, [](RenderSettings& s) { s.revoxelize = Revoxelize::changed; });
    }
    const auto& work = always->voxels().work();
    EXPECT_GE(work.all, 3);
    EXPECT_EQ(work.moving, 0);
}

TEST_F(GiDynamic, WhatIsVoxelizedAnewKeepsTheLightThatItGathered) {
    // Each frame gathers for the faces to one side: were the others' light lost, or gathered anew, frames would differ.
    Renderer once = new_renderer(), always = new_renderer();
    for (int step = 0; step < 5; ++step) {
        change_settings(scene, [](RenderSettings& s) { s.bounces = 0, s.revoxelize = Revoxelize::once; });
        const auto expected = frame(once, scene, camera);
        change_settings(scene, [](RenderSettings& s) { s.revoxelize = Revoxelize::always; });
        EXPECT_EQ(difference(frame(always, scene, camera), expected), 0) << step;
    }
    EXPECT_EQ(always->voxels().work().all, once->voxels().work().all + 4);
}

TEST_F(GiDynamic, OnlyWhatMovesIsVoxelizedAndTheSumsAreThoseOfAll) {
    Renderer live = new_renderer();
    frame(live, scene, camera);
    place(1);  // from here on the crate counts as moving
    frame(live, scene, camera);
    const auto before = live->voxels().work();
    for (int step = 2; step < 5; ++step) {
        place(step);
        frame(live, scene, camera);
        Renderer fresh = new_renderer();
        frame(fresh, scene, camera);
        EXPECT_EQ(records(live), records(fresh)) << step;
    }
    EXPECT_EQ(live->voxels().work().all, before.all);
    EXPECT_EQ(live->voxels().work().moving, before.moving + 3);
    const auto moved = live->voxels().work();
    scene.set_transform(light, {.translation = {0.1f, 1, 0}});
    frame(live, scene, camera);
    EXPECT_EQ(live->voxels().work().moving, moved.moving) << "a light is no surface";
    EXPECT_EQ(live->voxels().work().all, moved.all);
}

TEST_F(GiDynamic, AMovingBoxBesideAFineMeshCostsAFractionOfVoxelizingAll) {
    Geometry knot;
    knot.mesh = torus_knot_mesh(2, 3, 0.6f, 0.12f, 1500);
    ASSERT_GE(knot.mesh.triangle_count(), 200'000u);
    Node node;
    node.transform.translation = {0, 1, -0.2f};
    node.parts.push_back({scene.add_geometry(std::move(knot)), scene.add_material(lambert(glm::vec3(0.5f)))});
    scene.add_node(std::move(node));
    change_settings(scene, [](RenderSettings& s) { s.voxels = 64; });
    Renderer live = new_renderer();
    frame(live, scene, camera, 8);
    const auto voxelize = [&](Revoxelize revoxelize) {
        change_settings(scene, [&](RenderSettings& s) { s.revoxelize = revoxelize; });
        double best = 1e30;
        for (int step = 0; step < 4; ++step) {
            place_crate(step);
            realtime::PassTimes times;
            frame(live, scene, camera, 8, &times);
            best = std::min(best, milliseconds(times, "voxelize"));
        }
        return best;
    };
    const double all = voxelize(Revoxelize::always), moving = voxelize(Revoxelize::changed);
    if (prints_accuracy_table()) std::printf("| voxelize: all %.2f ms, what moves %.2f ms, ratio %.3f |\n", all, moving, moving / all);
    EXPECT_LT(moving, 0.5 * all);
}

TEST_F(GiDynamic, LightOfAllBouncesComesWithinAPercentInAFewFrames) {
    change_settings(scene, [](RenderSettings& settings) { settings.bounces = 0; });
    constexpr int rest = 100;
    struct Change {
        const char* name;
        int stated;  // frames
        std::function<void()> change;
    };
    // Faces that are new gather in the next frame, of the others those to one of six sides in each. Where little light is left, more of what
    // was there before has to be gone.
    const std::vector<Change> changes{
        {"a crate and a light move", 18, [&] { place(3); }},
        {"a light moves", 18, [&] { scene.set_transform(light, {.translation = {0.3f, 0.9f, -0.1f}}); }},
        {"all lights but a dim lamp go out", 66, [&] { scene.set_visible(light, false); }}};
    Renderer live = new_renderer();
    for (int i = 0; i < rest; ++i) frame(live, scene, camera, 8);
    for (const auto& [name, stated, change] : changes) {
        change();
        Renderer converged = new_renderer();
        for (int i = 0; i < rest; ++i) frame(converged, scene, camera, 8);
        const double goal = volume_light(converged);
        int last_wrong = 0;
        for (int i = 1; i <= rest; ++i) {
            frame(live, scene, camera, 8);
            if (std::abs(volume_light(live) / goal - 1) > 0.01) last_wrong = i;
        }
        if (prints_accuracy_table()) std::printf("| reflectance 0.73, %s: all bounces within 1 %% after %d frames |\n", name, last_wrong + 1);
        EXPECT_LT(last_wrong, stated) << name;
        EXPECT_GT(last_wrong, 0) << "the check must have something to check: " << name;
    }
}

}  // namespace
}  // namespace heliodon::tests
