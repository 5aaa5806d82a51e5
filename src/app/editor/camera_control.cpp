#include "app/editor/camera_control.h"

#include <algorithm>
#include <cmath>

namespace heliodon::editor {
namespace {

constexpr float pole_margin_rad = 0.01f;  // keeps the view direction off the up vector, where it has no right side

struct Axes {
    glm::vec3 forward, right, up;
};

Axes axes(const Camera& camera) {
    const glm::vec3 forward = glm::normalize(camera.target - camera.position);
    const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
    return {forward, right, glm::cross(right, forward)};
}

/// `arm` turned by `yaw` about the camera's up and by `pitch` about its right side, kept off the poles.
glm::vec3 turned(const Camera& camera, glm::vec3 arm, float yaw, float pitch) {
    const glm::vec3 up = glm::normalize(camera.up);
    const float from_pole = std::acos(std::clamp(glm::dot(glm::normalize(arm), up), -1.0f, 1.0f));
    const float kept = std::clamp(from_pole - pitch, pole_margin_rad, std::numbers::pi_v<float> - pole_margin_rad);
    const glm::vec3 side = glm::normalize(glm::cross(arm, up));
    const glm::quat tilt = glm::angleAxis(from_pole - kept, side);
    return glm::angleAxis(yaw, up) * (tilt * arm);
}

}  // namespace

// A drag across the window's height turns by half a circle.
Camera orbit(Camera camera, glm::vec2 delta, float height) {
    const float scale = std::numbers::pi_v<float> / std::max(height, 1.0f);
    camera.position = camera.target + turned(camera, camera.position - camera.target, -delta.x * scale, delta.y * scale);
    return camera;
}

Camera pan(Camera camera, glm::vec2 delta, float height) {
    const Axes a = axes(camera);
    const float distance = glm::length(camera.target - camera.position);
    const float metres_per_pixel = 2.0f * distance * std::tan(0.5f * camera.vertical_fov_rad) / std::max(height, 1.0f);
    const glm::vec3 shift = metres_per_pixel * (-delta.x * a.right + delta.y * a.up);
    camera.position += shift;
    camera.target += shift;
    return camera;
}

Camera dolly(Camera camera, float steps) {
    camera.position = camera.target + (camera.position - camera.target) * std::pow(0.9f, steps);
    return camera;
}

// A drag across the window's height looks through one vertical field of view.
Camera look(Camera camera, glm::vec2 delta, float height) {
    const float scale = camera.vertical_fov_rad / std::max(height, 1.0f);
    camera.target = camera.position + turned(camera, camera.target - camera.position, -delta.x * scale, -delta.y * scale);
    return camera;
}

Camera fly(Camera camera, glm::vec3 motion_m) {
    const Axes a = axes(camera);
    const glm::vec3 shift = motion_m.x * a.right + motion_m.y * glm::normalize(camera.up) + motion_m.z * a.forward;
    camera.position += shift;
    camera.target += shift;
    return camera;
}

}  // namespace heliodon::editor
