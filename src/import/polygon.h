#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace heliodon::import {

/// Corners of the triangles of a simple polygon, three a triangle, in its winding: ear clipping in the
/// plane of its mean normal; a fan where no ear is left (crossing or flat polygons).
[[nodiscard]] std::vector<std::uint32_t> triangulate(std::span<const glm::vec3> polygon);

}  // namespace heliodon::import
