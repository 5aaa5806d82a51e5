// Shadow maps are as fine as who looks at them can tell, and no finer.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "realtime/camera_frame.h"
#include "realtime/shadow_plan.h"

namespace heliodon::tests {
namespace {

constexpr int width = 256, height = 192;
const Bounds room{{-1, 0, -1}, {1, 2, 1}};

Camera camera_at(glm::vec3 position, glm::vec3 target) {
    Camera camera;
    camera.position = position;
    camera.target = target;
    camera.vertical_fov_rad = 0.7f;
    return camera;
}

shading::LightData light(std::uint32_t type, glm::vec3 axis = {0, -1, 0}) {
    shading::LightData data{};
    data.type = type;
    data.intensity = glm::vec3(10);
    data.position = {0.2f, 1.8f, -0.1f};
    data.axis = glm::normalize(axis);
    data.cos_inner = 0.9f;
    data.cos_outer = 0.8f;
    return data;
}

/// The largest quotient of a texel's width and a pixel's, at points that camera and view see, for each view.
std::vector<double> coarsest(const std::vector<shading::ShadowViewData>& views, const shading::FrameData& camera) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<float> unit;
    const float pixel = glm::length(camera.ray_dy);
    std::vector<double> result(views.size(), 0);
    for (int i = 0; i < 200'000; ++i) {
        const glm::vec3 p = room.min + room.extent() * glm::vec3(unit(generator), unit(generator), unit(generator));
        const glm::vec4 seen = camera.world_to_clip * glm::vec4(p, 1);
        if (seen.w < camera.near_m || std::abs(seen.x) > seen.w || std::abs(seen.y) > seen.w) continue;
        for (std::size_t v = 0; v < views.size(); ++v) {
            const glm::vec4 clip = views[v].world_to_clip * glm::vec4(p, 1);
            if (clip.w <= 0 || std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w) continue;
            const double half_width = clip.w * std::max(glm::length(views[v].axis_u), glm::length(views[v].axis_v));
            result[v] = std::max(result[v], 2 * half_width / views[v].size / (pixel * seen.w));
        }
    }
    return result;
}

TEST(ShadowDetail, NoTexelIsWiderThanAPixelWhereThePictureShowsItAndNoMapTwiceAsFineAsThat) {
    constexpr std::uint32_t largest = 4096;
    const std::vector<shading::LightData> lights{light(shading::light_type_point), light(shading::light_type_spot, {0.3f, -1, -0.2f}),
                                                 light(shading::light_type_directional, {0.5f, -1, 0.3f})};
    for (const Camera& camera : {camera_at({0, 1, 3.4f}, {0, 1, 0}), camera_at({3, 4, 2}, {0, 0.5f, 0}), camera_at({0, 1, 40}, {0, 1, 0})}) {
        const auto frame = realtime::camera_frame(camera, room, width, height, glm::vec2(0));
        const auto detail = realtime::shadow_detail(frame, room);
        const auto plan = realtime::plan_shadows(lights, room, {.layer_size = largest, .layers = 16, .views = 64}, &detail);
        const auto views = realtime::shadow_views(plan.views, lights, room, glm::vec2(0));
        ASSERT_EQ(views.size(), 8u);
        const auto widths = coarsest(views, frame);
        for (std::size_t v = 0; v < views.size(); ++v) {
            EXPECT_LE(widths[v], 1.01) << v;  // guard texels widen a view a little
            EXPECT_LT(views[v].size, largest) << v;
            // Points at random come close to the coarsest one; where none is seen the map is as small as maps get.
            EXPECT_GT(widths[v], views[v].size == 16 ? -1.0 : 0.4) << v << ' ' << views[v].size;
        }
    }
}

TEST(ShadowDetail, VoxelsAreLitByTexelsNoWiderThanTheyAreWhereNoPixelLooks) {
    const std::vector<shading::LightData> lights{light(shading::light_type_point)};
    auto detail = realtime::shadow_detail(realtime::camera_frame(camera_at({0, 1, 40}, {0, 1, 80}), room, width, height, glm::vec2(0)), room);
    const realtime::ShadowBudget budget{.layer_size = 2048, .layers = 16, .views = 64};
    const auto unseen = realtime::plan_shadows(lights, room, budget, &detail);
    for (const auto& view : unseen.views) EXPECT_EQ(view.place.size, 16u) << view.face;
    detail.voxel_m = 2.0f / 128;
    const auto lit = realtime::plan_shadows(lights, room, budget, &detail);
    // Half a map is as wide as the farthest the light's face reaches: 1.8 m down, 0.2 m up.
    EXPECT_EQ(lit.views[3].place.size, 256u);
    EXPECT_EQ(lit.views[2].place.size, 32u);
}

TEST(ShadowDetail, ACameraThatCanTouchWhatItSeesGetsTheLargestMaps) {
    const std::vector<shading::LightData> lights{light(shading::light_type_point)};
    const auto detail = realtime::shadow_detail(realtime::camera_frame(camera_at({0, 1, 0}, {0, 0, 0.1f}), room, width, height, glm::vec2(0)), room);
    const auto plan = realtime::plan_shadows(lights, room, {.layer_size = 2048, .layers = 16, .views = 64}, &detail);
    EXPECT_EQ(plan.views[3].place.size, 2048u);
}

}  // namespace
}  // namespace heliodon::tests
