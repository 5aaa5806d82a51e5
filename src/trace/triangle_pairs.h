#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scene/geometry.h"

namespace heliodon::trace {

/// A mesh as quadrilaterals of two triangles that share an edge, and of single triangles: half as many boxes to
/// enclose.
struct TrianglePairs {
    static constexpr std::uint32_t none = ~0u;
    static constexpr std::size_t most_triangles = std::size_t{1} << 30u;  ///< that Members can number
    /// A triangle's number times 4, plus which of its corners stands first.
    struct Members {
        std::uint32_t first, second;  ///< `second` none: a triangle alone
    };

    /// As Embree wants them: of the corners 0, 1, 3 and 2, 3, 1; alone 0, 1, 2, 2.
    std::vector<glm::uvec4> corners;
    std::vector<Members> members;
};

/// Each triangle with the neighbour whose box adds least to its own, if the common box is no larger than both together.
/// All triangles are in one pair, all with their own vertices.
[[nodiscard]] TrianglePairs pair_triangles(const Mesh& mesh);

/// From a point of the quadrilateral, as Embree names it, to the triangle that it is on and its coordinates there.
inline void unpair(const TrianglePairs::Members& members, std::uint32_t& triangle, float& u, float& v) {
    const bool second = u + v > 1 && members.second != TrianglePairs::none;
    const std::uint32_t member = second ? members.second : members.first;
    if (second) u = 1 - u, v = 1 - v;
    const float weights[] = {1 - u - v, u, v};  // of the corner that stands first, and those that follow
    const std::uint32_t first = member & 3u;
    triangle = member >> 2u;
    u = weights[(4 - first) % 3];
    v = weights[(5 - first) % 3];
}

}  // namespace heliodon::trace
