#include "trace/triangle_pairs.h"

#include <algorithm>
#include <limits>

namespace heliodon::trace {
namespace {

/// The triangles around each vertex.
class Neighbours {
public:
    explicit Neighbours(const Mesh& mesh)
        : mesh_(mesh), begin_(mesh.positions.size() + 1), around_(mesh.indices.size()) {
        for (const std::uint32_t vertex : mesh.indices) ++begin_[vertex];
        std::uint32_t sum = 0;
        for (std::uint32_t& begin : begin_) begin = sum += begin;  // the end, until the triangles stand before it
        for (std::size_t i = mesh.indices.size(); i-- > 0;)
            around_[--begin_[mesh.indices[i]]] = static_cast<std::uint32_t>(i / 3);
    }

    /// Calls `visit(triangle, corner)` for those that have the edge from `a` to `b`, opposite to their `corner`.
    template <class Visit>
    void with_edge(std::uint32_t a, std::uint32_t b, Visit&& visit) const {
        const std::uint32_t vertex =
            begin_[a + 1] - begin_[a] < begin_[b + 1] - begin_[b] ? a : b;  // fans have few at the rim
        for (std::uint32_t i = begin_[vertex]; i < begin_[vertex + 1]; ++i) {
            const std::uint32_t* corners = &mesh_.indices[3 * static_cast<std::size_t>(around_[i])];
            for (std::uint32_t corner = 0; corner < 3; ++corner)
                if (corners[(corner + 1) % 3] == a && corners[(corner + 2) % 3] == b) visit(around_[i], corner);
        }
    }

private:
    const Mesh& mesh_;
    std::vector<std::uint32_t> begin_, around_;
};

}  // namespace

TrianglePairs pair_triangles(const Mesh& mesh) {
    const Neighbours neighbours(mesh);
    const std::size_t count = mesh.triangle_count();
    const auto corners = [&](std::size_t triangle) { return &mesh.indices[3 * triangle]; };
    const auto box = [&](std::size_t triangle) {
        Bounds box;
        for (int i = 0; i < 3; ++i) box.include(mesh.positions[corners(triangle)[i]]);
        return box;
    };
    const auto area = [](const Bounds& box) {
        const glm::vec3 size = box.extent();
        return size.x * size.y + size.y * size.z + size.z * size.x;
    };
    TrianglePairs pairs;
    pairs.corners.reserve(count / 2 + count / 16);
    pairs.members.reserve(count / 2 + count / 16);
    std::vector<bool> taken(count, false);
    for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
        if (taken[triangle]) continue;
        taken[triangle] = true;
        const std::uint32_t* own = corners(triangle);
        const Bounds own_box = box(triangle);
        const float own_area = area(own_box);
        float least = std::numeric_limits<float>::infinity();
        std::uint32_t first = 0, other = 0, other_first = 0;
        for (std::uint32_t corner = 0; corner < 3; ++corner)
            neighbours.with_edge(
                own[(corner + 2) % 3], own[(corner + 1) % 3], [&](std::uint32_t neighbour, std::uint32_t opposite) {
                    if (taken[neighbour]) return;
                    Bounds both = own_box;
                    const Bounds its = box(neighbour);
                    both.include(its);
                    const float ratio = area(both) / std::max(own_area + area(its), std::numeric_limits<float>::min());
                    if (ratio < least) least = ratio, first = corner, other = neighbour, other_first = opposite;
                });
        if (least <= 1) {
            taken[other] = true;
            pairs.corners.emplace_back(own[first], own[(first + 1) % 3], corners(other)[other_first],
                                       own[(first + 2) % 3]);
            pairs.members.push_back({triangle << 2u | first, other << 2u | other_first});
        } else {
            pairs.corners.emplace_back(own[0], own[1], own[2], own[2]);
            pairs.members.push_back({triangle << 2u, TrianglePairs::none});
        }
    }
    return pairs;
}

}  // namespace heliodon::trace
