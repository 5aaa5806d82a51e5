#include "app/editor/camera_control.h"

#include <gtest/gtest.h>

#include <cmath>

namespace heliodon::editor {
namespace {

Camera camera() { return {.position = {0, 1, 4}, .target = {0, 1, 0}}; }
float distance(const Camera& c) { return glm::length(c.position - c.target); }
glm::vec3 forward(const Camera& c) { return glm::normalize(c.target - c.position); }

TEST(CameraControl, orbiting_keeps_the_distance_and_the_target) {
    const Camera turned = orbit(camera(), {120, 40}, 600);
    EXPECT_NEAR(distance(turned), 4.0f, 1e-4f);
    EXPECT_EQ(turned.target, camera().target);
}

TEST(CameraControl, dragging_right_by_half_the_height_shows_the_left_side) {
    const Camera turned = orbit(camera(), {300, 0}, 600);
    EXPECT_NEAR(turned.position.x, -4.0f, 1e-4f);
    EXPECT_NEAR(turned.position.z, 0.0f, 1e-4f);
}

TEST(CameraControl, dragging_down_lifts_the_camera_and_never_tips_over_the_pole) {
    EXPECT_GT(orbit(camera(), {0, 50}, 600).position.y, 1.0f);
    Camera c = camera();
    for (int i = 0; i < 50; ++i) c = orbit(c, {0, 100}, 600);
    EXPECT_NEAR(distance(c), 4.0f, 1e-3f);
    EXPECT_GT(glm::length(glm::cross(forward(c), c.up)), 0.005f);
    EXPECT_GT(c.position.y, 4.9f);
}

TEST(CameraControl, panning_by_the_window_height_shifts_by_what_it_shows) {
    const Camera c = pan(camera(), {0, 600}, 600);
    EXPECT_NEAR(c.position.y - 1.0f, 2.0f * 4.0f * std::tan(0.5f * c.vertical_fov_rad), 1e-4f);
    EXPECT_NEAR(distance(c), 4.0f, 1e-4f);
}

TEST(CameraControl, dollying_approaches_but_never_reaches_the_target) {
    EXPECT_NEAR(distance(dolly(camera(), 1)), 3.6f, 1e-4f);
    EXPECT_GT(distance(dolly(camera(), 200)), 0.0f);
    EXPECT_GT(distance(dolly(camera(), -1)), 4.0f);
}

TEST(CameraControl, looking_right_turns_the_view_right_and_stays_in_place) {
    const Camera c = look(camera(), {100, 0}, 600);
    EXPECT_EQ(c.position, camera().position);
    EXPECT_GT(forward(c).x, 0.0f);
    EXPECT_GT(forward(look(camera(), {0, -100}, 600)).y, 0.0f);
}

TEST(CameraControl, flying_moves_camera_and_target_along_the_view) {
    const Camera c = fly(camera(), {1, 2, 3});
    EXPECT_NEAR(c.position.x, 1.0f, 1e-5f);
    EXPECT_NEAR(c.position.y, 3.0f, 1e-5f);
    EXPECT_NEAR(c.position.z, 1.0f, 1e-5f);
    EXPECT_NEAR(c.target.z, -3.0f, 1e-5f);
}

}  // namespace
}  // namespace heliodon::editor
