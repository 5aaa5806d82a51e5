#include "scene/camera.h"

#include <cmath>

namespace heliodon {

float Camera::ev100() const {
    if (ev100_override) return *ev100_override;
    // ISO 2720:1974, exposure value referred to ISO 100.
    return std::log2(aperture_f * aperture_f / shutter_s * 100.0f / iso);
}

glm::mat4 Camera::world_to_view() const {
    const glm::vec3 forward = glm::normalize(target - position);
    glm::vec3 side = glm::cross(forward, up);
    if (glm::dot(side, side) < 1e-12f * glm::dot(up, up)) {
        const glm::vec3 other = std::abs(forward.z) < 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
        side = glm::cross(forward, other);
    }
    return glm::lookAt(position, target, glm::cross(side, forward));
}

}  // namespace heliodon
