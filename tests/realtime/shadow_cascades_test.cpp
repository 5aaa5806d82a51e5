// Shadow maps that follow the camera: where they lie, that they show no seams, and penumbrae as wide as the sun makes them.
#include <cmath>
#include <cstring>
#include <random>

#include "engine_parity.h"
#include "gi_live.h"
#include "realtime/camera_frame.h"
#include "realtime/shadow_plan.h"
#include "shading/light.h"

namespace heliodon::tests {
namespace {

constexpr float pi = 3.14159265f;
const Bounds town{{-200, 0, -150}, {200, 40, 150}};
constexpr realtime::ShadowBudget budget{.layer_size = 2048, .layers = 16, .views = 64};

Camera street_camera(glm::vec3 position = {3.21f, 1.7f, 5.43f}, float turn_rad = 0.3f) {
    Camera camera;
    camera.position = position;
    camera.target = position + glm::vec3(std::sin(turn_rad), -0.1f, -std::cos(turn_rad));
    camera.vertical_fov_rad = 0.9f;
    return camera;
}

/// The views of a slanting sun's light for a camera in the town.
struct SunViews {
    shading::FrameData frame;
    realtime::ShadowCascades cascades;
    std::vector<shading::ShadowViewData> views;

    explicit SunViews(const Camera& camera, const ShadowCascadeSettings& settings = {}, const Bounds& scene = town) {
        shading::LightData sun{};
        sun.type = shading::light_type_directional;
        sun.intensity = glm::vec3(1e5f);
        sun.axis = glm::normalize(glm::vec3(0.5f, -0.8f, 0.35f));
        frame = realtime::camera_frame(camera, scene, 320, 240, glm::vec2(0));
        cascades = realtime::shadow_cascades(settings, realtime::shadow_detail(frame, scene));
        const std::array lights{sun};
        const auto plan = realtime::plan_shadows(lights, scene, budget, nullptr, cascades);
        views = realtime::shadow_views(plan.views, lights, scene, glm::vec2(0), cascades);
    }
    /// The first view that has all the say about a point, by the lookup's own rule.
    [[nodiscard]] int deciding(glm::vec3 p) const {
        for (std::size_t v = 0; v < views.size(); ++v) {
            if (views[v].kind == shading::shadow_kind_none) continue;
            const glm::vec4 clip = views[v].world_to_clip * glm::vec4(p, 1);
            const float inside = 1 - std::max(std::abs(clip.x), std::abs(clip.y));
            if (inside >= (views[v].wider ? views[v].border : 0) && clip.z >= 0 && clip.z <= 1) return static_cast<int>(v);
        }
        return -1;
    }
};

bool same(const shading::ShadowViewData& a, const shading::ShadowViewData& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(ShadowCascades, ACameraThatMovesTakesViewsAlongByWholeTexels) {
    const SunViews before(street_camera());
    std::array<int, 4> moved{};
    const int steps = 200;
    for (int i = 0; i < steps; ++i) {
        const SunViews after(street_camera({3.21f + 0.01f * i, 1.7f, 5.43f - 0.004f * i}));
        ASSERT_EQ(after.views.size(), 5u);
        for (int v = 0; v < 4; ++v) {
            const auto &a = before.views[v], &b = after.views[v];
            ASSERT_EQ(a.axis_u, b.axis_u) << "no map changes its width";
            if (same(a, b)) continue;
            ++moved[v];
            const double texel = 2 * double(glm::length(a.axis_u)) / a.size;
            for (const glm::vec3 axis : {a.axis_u, a.axis_v}) {
                const double shift = glm::dot(glm::dvec3(b.origin) - glm::dvec3(a.origin), glm::normalize(glm::dvec3(axis))) / texel;
                EXPECT_NEAR(shift, std::round(shift), 2e-3) << v;
            }
        }
    }
    EXPECT_GT(moved[0], steps / 2) << "2 m are more than a step of the narrowest map";
    EXPECT_EQ(moved[3], 0) << "and less than one of the widest";
}

TEST(ShadowCascades, ACameraThatTurnsChangesNoWidth) {
    const SunViews before(street_camera());
    for (float turn = 0; turn < 6.28f; turn += 0.37f) {
        const SunViews after(street_camera({3.21f, 1.7f, 5.43f}, turn));
        for (std::size_t v = 0; v < before.views.size(); ++v) {
            EXPECT_EQ(before.views[v].axis_u, after.views[v].axis_u) << v;
            EXPECT_EQ(before.views[v].size, after.views[v].size) << v;
            EXPECT_EQ(before.views[v].range_m, after.views[v].range_m) << v;
        }
    }
}

TEST(ShadowCascades, EveryPointThatTheCameraSeesLiesInAViewAndTheNearestInTheNarrowest) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> unit;
    for (int count = 1; count <= most_shadow_cascades; ++count)
        for (const float split : {0.0f, 0.5f, 1.0f})
            for (const float blend : {0.0f, 0.125f, 0.5f}) {
                const SunViews sun(street_camera({120, 10, 80}, 0.7f + count), {.count = count, .split = split, .blend = blend});
                const auto& slices = sun.cascades.slices;
                ASSERT_EQ(slices.size(), static_cast<std::size_t>(count));
                for (int i = 0; i < 2000; ++i) {
                    const float depth = 0.02f * std::pow(25000.0f, unit(generator));
                    const glm::vec2 pixel(320 * unit(generator), 240 * unit(generator));
                    const glm::vec3 p = sun.frame.position + depth * (sun.frame.ray_corner + pixel.x * sun.frame.ray_dx + pixel.y * sun.frame.ray_dy);
                    if (glm::any(glm::lessThan(p, town.min)) || glm::any(glm::greaterThan(p, town.max))) continue;
                    const int view = sun.deciding(p);
                    ASSERT_GE(view, 0) << count << ' ' << split << ' ' << blend << " at " << depth;
                    const auto own = std::find_if(slices.begin(), slices.end(), [&](const auto& slice) { return depth <= slice.far_m; }) - slices.begin();
                    if (sun.views[own].kind != shading::shadow_kind_none) { EXPECT_LE(view, own) << depth; }
                }
            }
}

TEST(ShadowCascades, ThoseNoNarrowerThanTheSceneHaveNoMap) {
    const Bounds room{{-3, 0, -3}, {3, 3, 3}};
    const SunViews inside(street_camera({0, 1.5f, 2.5f}), {}, room), outside(street_camera({0, 1.5f, 60}), {}, room);
    EXPECT_EQ(inside.views[0].kind, shading::shadow_kind_orthographic);
    EXPECT_EQ(inside.views[3].kind, shading::shadow_kind_none);
    for (int v = 0; v < 4; ++v) EXPECT_EQ(outside.views[v].kind, shading::shadow_kind_none) << v;
    EXPECT_EQ(outside.views[4].kind, shading::shadow_kind_orthographic);
}

TEST(ShadowCascades, BeyondTheirDistanceTheMapOfTheSceneServes) {
    const SunViews near(street_camera(), {.distance_m = 50});
    EXPECT_FLOAT_EQ(near.cascades.slices.back().far_m, 50);
    EXPECT_EQ(near.views[4].kind, shading::shadow_kind_orthographic);
    EXPECT_EQ(near.deciding(near.frame.position + 100.0f * near.frame.forward), 4);
}

void set_cascades(Scene& scene, const ShadowCascadeSettings& cascades, int map_size = 0) {
    RenderSettings settings = scene.render_settings();
    settings.shadow_cascades = cascades;
    settings.shadow_map_size = map_size;
    scene.set_render_settings(settings);
}

NodeId add_disc_sun(Scene& scene, glm::vec3 direction, glm::vec3 lux, float diameter_deg) {
    Node node;
    node.light = Light{.type = LightType::directional, .intensity = lux, .direction = glm::normalize(direction)};
    node.light->angular_diameter_rad = glm::radians(diameter_deg);
    return scene.add_node(std::move(node));
}

/// A floor to 60 m and a wall of 2 m along the view, whose shadow ends on the line x = 1 m.
struct LongWall {
    Scene scene;
    Camera camera;
    glm::vec3 to_sun = glm::normalize(glm::vec3(-1, 1, 0));

    explicit LongWall(bool wall, float diameter_deg) {
        const MaterialId white = scene.add_material(lambert(glm::vec3(1)));
        add_floor(scene, 60, white);
        add_shape_node(scene, Box{{20, 0, 30}, {24, 10, 34}}, white);  // behind the camera
        if (wall) add_shape_node(scene, Box{{-1.2f, 0, -60}, {-1, 2, 20}}, white);
        add_disc_sun(scene, -to_sun, glm::vec3(pi), diameter_deg);
        camera.position = {1.5f, 1.7f, 10};
        camera.target = {1.2f, 1.0f, 0};
        camera.vertical_fov_rad = 1;
        camera.ev100_override = 3.0f;
    }
};

class ShadowCascadesSeen : public EngineParity {
protected:
    /// A renderer follows one scene.
    void renew() { TearDown(), SetUp(); }
};

TEST_F(ShadowCascadesSeen, ALitPlaneAcrossAllOfThemIsEvenlyLit) {
    LongWall open(false, 0.53f);
    for (int count = 1; count <= most_shadow_cascades; ++count)
        for (const int samples : {1, 4}) {
            set_cascades(open.scene, {.count = count});
            const Image image = render(open.scene, open.camera, 64, samples);
            const float expected = open.to_sun.y;
            for (int y = 40; y < 64; ++y)
                for (int x = 0; x < 64; ++x) ASSERT_NEAR(image.at(x, y), expected, 2e-3f * expected) << count << ' ' << samples << ' ' << x << ' ' << y;
        }
}

TEST_F(ShadowCascadesSeen, APlaneInShadowAcrossAllOfThemIsBlack) {
    LongWall shaded(false, 2);
    add_shape_node(shaded.scene, Box{{-120, 12, -80}, {80, 13, 80}}, shaded.scene.add_material(lambert(glm::vec3(1))));
    for (const int count : {1, 4, 8})
        for (const float blend : {0.0f, 0.125f}) {
            set_cascades(shaded.scene, {.count = count, .blend = blend});
            const Image image = render(shaded.scene, shaded.camera, 64, 1);
            for (int y = 40; y < 64; ++y)
                for (int x = 0; x < 64; ++x) ASSERT_EQ(image.at(x, y), 0) << count << ' ' << blend << ' ' << x << ' ' << y;
        }
}

TEST_F(ShadowCascadesSeen, AShadowsEdgeGoesOnAcrossTheirBorders) {
    constexpr int size = 128;
    LongWall wall(true, 0);
    for (const int count : {2, 4, 8}) {
        set_cascades(wall.scene, {.count = count});
        const Image image = render(wall.scene, wall.camera, size, 1);
        const auto frame = realtime::camera_frame(wall.camera, Bounds{{-60, 0, -60}, {60, 10, 60}}, size, size, glm::vec2(0));
        double worst = 0;
        int rows = 0;
        for (int y = 0; y < size; ++y) {
            // Where in this row the line lies, and where the picture turns from shadow to light.
            const auto along = [&](float x) { return frame.ray_corner + x * frame.ray_dx + (y + 0.5f) * frame.ray_dy; };
            if (along(0).y >= -0.05f) continue;  // 34 m ahead
            const auto floor_x = [&](float x) { return frame.position.x - frame.position.y / along(x).y * along(x).x; };
            const float slope = floor_x(1) - floor_x(0), exact = (1 - floor_x(0)) / slope;
            if (!(exact > 4 && exact < size - 4)) continue;
            float lit = 0;  // pixels right of the middle of a window
            for (int x = static_cast<int>(exact) - 3; x <= static_cast<int>(exact) + 3; ++x) lit += std::min(image.at(x, y) / wall.to_sun.y, 1.0f);
            const double found = static_cast<int>(exact) + 4 - lit;
            worst = std::max(worst, std::abs(found - exact));
            ++rows;
        }
        EXPECT_GT(rows, 40);
        EXPECT_LE(worst, 1.0) << "pixels, with " << count;
    }
}

/// A sheet's straight edge between a floor and a light above.
struct EdgeAbove {
    Scene scene;
    NodeId sheet;
    EdgeAbove() {
        const MaterialId white = scene.add_material(lambert(glm::vec3(1)));
        add_floor(scene, 10, white);
        sheet = add_shape_node(scene, Quad{{-9, 0, -9}, {0, 0, 18}, {9, 0, 0}}, white);
        set_cascades(scene, {}, 2048);
    }
};

/// Across the picture: how much light comes in, and its mean place and standard deviation in metres.
struct Profile {
    double mass = 0, middle = 0, deviation = 0;
    Profile(const Image& image, float half) {
        const int size = image.width, rows = size / 2;
        double first = 0, second = 0;
        for (int x = 0; x + 1 < size; ++x) {
            double step = 0;
            for (int y = size / 4; y < size / 4 + rows; ++y) step += (image.at(x + 1, y) - image.at(x, y)) / rows;
            const double at = (2.0 * (x + 1) / size - 1) * half;
            mass += step, first += step * at, second += step * at * at;
        }
        middle = first / mass;
        deviation = std::sqrt(second / mass - middle * middle);
    }
};

TEST_F(ShadowCascadesSeen, ALivePenumbraIsAsWideAsTheSunsDiscMakesIt) {
    EdgeAbove edge;
    Scene& scene = edge.scene;
    const NodeId sun = add_disc_sun(scene, {0, -1, 0}, glm::vec3(pi), 1);
    for (const float diameter_deg : {0.53f, 2.0f, 5.0f})
        for (const float height : {1.0f, 2.0f, 4.0f}) {
            ASSERT_TRUE(scene.set_transform(edge.sheet, Transform{.translation = {0, height, 0}}));
            Light disc = *scene.nodes().find(sun)->light;
            disc.angular_diameter_rad = glm::radians(diameter_deg);
            ASSERT_TRUE(scene.set_light(sun, disc));
            const float expected = height * 2 * std::tan(glm::radians(0.5f * diameter_deg));
            const float half = 1.2f * expected;
            const Profile profile(render(scene, camera_above(1.5f * half, half), 96), half);
            EXPECT_NEAR(profile.mass, 1, 0.02) << diameter_deg << "° " << height << " m";
            EXPECT_NEAR(profile.middle, 0, 0.03 * expected) << diameter_deg << "° " << height << " m";
            // The profile's derivative is the disc's chords: their variance is a quarter of its radius squared.
            EXPECT_NEAR(4 * profile.deviation, expected, 0.02 * expected) << diameter_deg << "° " << height << " m";
        }
}

TEST_F(ShadowCascadesSeen, ThePenumbraOfTheSkysSunIsNarrowerByItsDarkLimb) {
    const float half = 0.08f, height = 2, diameter_rad = glm::radians(2.0f);
    EdgeAbove edge;
    ASSERT_TRUE(edge.scene.set_transform(edge.sheet, Transform{.translation = {0, height, 0}}));
    const auto deviation = [&] {
        RealtimeOptions options;
        options.width = options.height = 96;
        options.samples = 1;
        options.environment = false;
        return Profile(render(edge.scene, camera_above(1.5f * half, half), options).image, half).deviation;
    };
    Sky daylight;
    daylight.model = SkyModel::preetham;
    daylight.sun_elevation_rad = 0.5f * pi;
    daylight.sun_angular_diameter_rad = diameter_rad;
    edge.scene.set_sky(daylight);
    const double darkened = deviation();
    edge.scene.set_sky({});
    add_disc_sun(edge.scene, {0, -1, 0}, glm::vec3(pi), glm::degrees(diameter_rad));
    // The variance across a disc is half its mean squared radius.
    double light = 0, squares = 0;
    for (int i = 0; i < 1000; ++i) {
        const double square = (i + 0.5) / 1000, luminance = shading::limb_darkening(static_cast<float>(square));
        light += luminance, squares += luminance * square;
    }
    const double narrower = std::sqrt(2 * squares / light);
    EXPECT_LT(narrower, 0.98);
    EXPECT_NEAR(darkened / deviation(), narrower, 0.005);
}

TEST_F(ShadowCascadesSeen, ADiscAsWideAsTheSkyIsHalfHiddenByAnEdgeAbove) {
    EdgeAbove edge;
    ASSERT_TRUE(edge.scene.set_transform(edge.sheet, Transform{.translation = {0, 1, 0}}));
    const NodeId sun = add_disc_sun(edge.scene, {0, -1, 0}, glm::vec3(pi), 1);
    for (const float diameter_deg : {90.0f, 150.0f, 180.0f}) {
        Light disc = *edge.scene.nodes().find(sun)->light;
        disc.angular_diameter_rad = glm::radians(diameter_deg);
        ASSERT_TRUE(edge.scene.set_light(sun, disc));
        const Image image = render(edge.scene, camera_above(0.5f, 0.02f), 4);
        for (const float value : image.pixels) EXPECT_NEAR(value, 0.5f, 0.08f) << diameter_deg;
    }
}

/// A street of houses of several heights with a hedge of posts, in the evening.
Scene street(float diameter_deg) {
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.7f)));
    add_floor(scene, 40, white);
    for (int i = 0; i < 8; ++i) {
        const float z = 6 - 6.0f * i, height = 2.0f + 1.5f * (i % 3);
        add_shape_node(scene, Box{{-7, 0, z - 2}, {-4, height, z + 1}}, white);
        add_shape_node(scene, Box{{4 + 0.5f * (i % 2), 0, z - 1}, {7, 3, z + 1.5f}}, white);
        for (int post = 0; post < 4; ++post) add_shape_node(scene, Box{{1.8f, 0, z + post}, {1.9f, 0.8f, z + 0.1f + post}}, white);
    }
    add_disc_sun(scene, {0.8f, -0.7f, -0.2f}, glm::vec3(1e4f), diameter_deg);
    Camera camera;
    camera.position = {0, 1.7f, 10};
    camera.target = {0, 1.2f, 0};
    camera.vertical_fov_rad = 1;
    camera.ev100_override = 11.0f;
    scene.add_camera(camera);
    return scene;
}

TEST_F(ShadowCascadesSeen, StillPicturesOfASunWithADiscAreThePathTracers) {
    expect_agreement(street(0.53f), {.size = 96, .path_samples = 256}, {0.001, 0.001, 0.0035});
    renew();
    expect_agreement(street(5), {.size = 96, .path_samples = 256}, {0.001, 0.001, 0.007});
}

TEST_F(ShadowCascadesSeen, LivePicturesOfASunWithADiscComeCloseToThePathTracers) {
    expect_agreement(street(0.53f), {.size = 96, .realtime_samples = 1, .path_samples = 256}, {0.001, 0.03, 0.043});
    renew();
    expect_agreement(street(5), {.size = 96, .realtime_samples = 1, .path_samples = 256}, {0.001, 0.04, 0.043});
}

class ShadowCascadesLive : public LiveFrames {
protected:
    static std::uint64_t maps_of(Renderer& renderer, const Scene& scene, const Camera& camera, bool force = false) {
        if (auto updated = renderer->update(scene); !updated) throw std::runtime_error(updated.error().text());
        expect(renderer->resize(64, 64, false));
        realtime::FrameSample sample;
        sample.count = 0;
        sample.force_shadows = force;
        const std::uint64_t before = renderer->shadow_maps_drawn();
        expect(renderer->render(camera, sample));
        return renderer->shadow_maps_drawn() - before;
    }
    void check(Rasterizer rasterizer) {
        Renderer renderer = new_renderer();
        LongWall wall(true, 0.53f);
        set_cascades(wall.scene, {});
        change_settings(wall.scene, [&](RenderSettings& s) { s.rasterizer = rasterizer; });
        const std::uint64_t all = maps_of(renderer, wall.scene, wall.camera);
        EXPECT_GE(all, 3u);
        EXPECT_EQ(maps_of(renderer, wall.scene, wall.camera), 0u) << "nothing moved";
        EXPECT_EQ(maps_of(renderer, wall.scene, wall.camera, true), all) << "forced";
        Camera moved = wall.camera;
        moved.position.x += 1e-4f, moved.target.x += 1e-4f;
        EXPECT_EQ(maps_of(renderer, wall.scene, moved), 0u) << "less than a texel";
        moved.position.x += 0.5f, moved.target.x += 0.5f;
        const std::uint64_t some = maps_of(renderer, wall.scene, moved);
        EXPECT_GT(some, 0u) << "the narrowest";
        EXPECT_LT(some, all) << "but not the widest";
        ASSERT_TRUE(wall.scene.set_transform(wall.scene.nodes().id_at(1), Transform{.translation = {0, 0, 1}}));
        EXPECT_EQ(maps_of(renderer, wall.scene, moved), all) << "something moved";
        for (std::uint32_t i = 0; i < wall.scene.nodes().capacity(); ++i)
            if (const Node* node = wall.scene.nodes().at(i); node && node->light) {
                Light light = *node->light;
                light.direction = glm::normalize(glm::vec3(1, -1, 0.01f));
                ASSERT_TRUE(wall.scene.set_light(wall.scene.nodes().id_at(i), light));
            }
        EXPECT_EQ(maps_of(renderer, wall.scene, moved), all) << "the sun moved";
    }
};

TEST_F(ShadowCascadesLive, MapsAreDrawnWhereWhatTheyShowHasChanged) { check(Rasterizer::hardware); }
TEST_F(ShadowCascadesLive, LikewiseByCompute) { check(Rasterizer::compute); }

}  // namespace
}  // namespace heliodon::tests
