#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/math.h"
#include "shading/kernel_state.h"

namespace heliodon::trace {

/// Where a group of lights is, which way they shine and how strongly: leaves bound what they hold exactly.
struct LightBounds {
    Bounds box;
    glm::vec3 axis{0, 0, 1};
    double normals_rad = 0;   ///< their normals lie within this of `axis`; or of −axis, if two-sided
    double emission_rad = 0;  ///< and they shine within this of a normal
    double intensity_cd = 0;  ///< sum of their luminous intensities along the normal
    bool two_sided = false;
};

/// A binary tree of bounds over the lights, node 0 its root, every pair of children side by side. Empty without lights.
/// `emitters`: the number that the leaf of each carries. `leaf_of` tells each one's leaf, in the same order.
[[nodiscard]] std::vector<shading::KernelLightNode> build_light_tree(std::span<const LightBounds> lights,
                                                                     std::span<const std::uint32_t> emitters,
                                                                     std::vector<std::uint32_t>& leaf_of);

}  // namespace heliodon::trace
