#pragma once

#include <cstdint>
#include <vector>

#include "scene/geometry.h"

namespace heliodon::convert {

/// For each vertex the first one at its position.
[[nodiscard]] std::vector<std::uint32_t> weld(const Mesh& mesh);

/// Whether the triangles bound volumes and face out of them, so that nobody outside sees a rear: with vertices
/// welded where their positions are equal, each edge is used as often in one direction as in the other, and each
/// connected piece encloses a positive volume. What fails this (the area that would fill the holes, pieces that face
/// inward, as a cavity does) may be a thousandth of the whole area: scanned models have a few holes, through which no
/// more than that share of their light could go. Triangles with two equal corners do not count. Linear time.
[[nodiscard]] bool is_closed(const Mesh& mesh);

}  // namespace heliodon::convert
