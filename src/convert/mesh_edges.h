#pragma once

#include <cstdint>
#include <vector>

#include "scene/geometry.h"

namespace heliodon::convert {

/// An edge of a mesh: two vertices, each the first one at its position.
struct MeshEdge {
    std::uint32_t a = 0, b = 0;
    std::uint32_t first_use = 0, use_count = 0;  ///< in MeshEdges::uses
};
/// The edges of a mesh whose vertices are welded where their positions are equal, and the triangles about each,
/// however many: meshes need not be manifold. Triangles with two corners in one place have none.
struct MeshEdges {
    std::vector<MeshEdge> edges;
    std::vector<std::uint32_t> uses;  ///< triangle · 2, + 1 where it goes round from b to a
};
/// O(n log n).
[[nodiscard]] MeshEdges mesh_edges(const Mesh& mesh);

}  // namespace heliodon::convert
