#pragma once

#include "core/math.h"

namespace heliodon::shading {

/// The lobe of radiance e^(κ a·ω) over a plane. Of all whose flux through the plane has the same mean direction it is the one of
/// most entropy relative to an even one, whose axis `a` is the normal: an even one's flux has the mean (0, 2/3).
struct PlaneLobe {
    glm::dvec2 mean{0};       ///< of the lobe over the whole sphere: a, so long that lobe_concentration() is κ; x along the plane, y the normal
    double clamped_cosine{};  ///< over the whole sphere, the mean of max(0, cosine to the normal)
};

/// The lobe whose flux has the mean direction `flux_mean`, of length < 1, y > 0: in both moments right within 10⁻⁴, and where
/// they are longer than 0.98, to first order in its width.
[[nodiscard]] PlaneLobe plane_lobe(glm::dvec2 flux_mean);

}  // namespace heliodon::shading
