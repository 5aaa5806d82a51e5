#pragma once

#ifndef GLM_FORCE_DEPTH_ZERO_TO_ONE
#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#endif
#ifndef GLM_ENABLE_EXPERIMENTAL
#define GLM_ENABLE_EXPERIMENTAL
#endif

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>

namespace heliodon {

/// Axis-aligned box; empty when `min > max`.
struct Bounds {
    glm::vec3 min{std::numeric_limits<float>::infinity()};
    glm::vec3 max{-std::numeric_limits<float>::infinity()};

    [[nodiscard]] bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    [[nodiscard]] glm::vec3 center() const { return 0.5f * (min + max); }
    [[nodiscard]] glm::vec3 extent() const { return empty() ? glm::vec3(0) : max - min; }
    [[nodiscard]] float diagonal() const { return glm::length(extent()); }

    void include(glm::vec3 point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    void include(const Bounds& other) {
        if (other.empty()) return;
        include(other.min);
        include(other.max);
    }
    /// The box around this box's eight corners after `transform`.
    [[nodiscard]] Bounds transformed(const glm::mat4& transform) const {
        Bounds result;
        if (empty()) return result;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 point((corner & 1) ? max.x : min.x, (corner & 2) ? max.y : min.y,
                                  (corner & 4) ? max.z : min.z);
            result.include(glm::vec3(transform * glm::vec4(point, 1.0f)));
        }
        return result;
    }
};

}  // namespace heliodon
