#pragma once

#include <algorithm>
#include <cmath>

#include "core/math.h"

namespace heliodon::realtime {

/// Unit and orthogonal; `forward` is the way that the light travels.
struct LightAxes {
    glm::vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, 1};
};

inline LightAxes axes_along(glm::vec3 forward) {
    const glm::vec3 aside = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 right = glm::normalize(glm::cross(forward, aside));
    return {right, glm::cross(right, forward), forward};
}

/// The scene in a light's axes, with a margin of a thousandth, which keeps flat scenes from a range of zero and what
/// lies on the box inside it.
inline Bounds seen_along(const LightAxes& axes, const Bounds& scene) {
    Bounds seen;
    const Bounds bounds = scene.empty() ? Bounds{glm::vec3(-1), glm::vec3(1)} : scene;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                          corner & 4 ? bounds.max.z : bounds.min.z);
        seen.include({glm::dot(p, axes.right), glm::dot(p, axes.up), glm::dot(p, axes.forward)});
    }
    const float margin = 1e-3f * std::max(seen.diagonal(), 1e-6f);
    return {seen.min - margin, seen.max + margin};
}

}  // namespace heliodon::realtime
