#include "scene/camera.h"

#include <cmath>

#include "core/units.h"

namespace heliodon {

float Camera::ev100() const {
    if (ev100_override) return *ev100_override;
    return units::ev100_from_camera(aperture_f, shutter_s, iso);
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
