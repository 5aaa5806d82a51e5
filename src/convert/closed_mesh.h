#pragma once

#include "scene/geometry.h"

namespace heliodon::convert {

/// Whether the triangles bound volumes and face out of them, so that nobody outside sees a rear: with vertices
/// welded where their positions are equal, every edge is used as often in one direction as in the other, and each
/// connected piece encloses a positive volume. Triangles with two equal corners do not count. Linear time. Exact
/// but for hashing: a mesh with a boundary passes with a chance of 2⁻⁶³. Cavities (pieces that face inward) and
/// self-intersections that turn a piece's volume negative read as not closed.
[[nodiscard]] bool is_closed(const Mesh& mesh);

}  // namespace heliodon::convert
