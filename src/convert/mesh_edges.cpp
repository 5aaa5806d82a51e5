#include "convert/mesh_edges.h"

#include <algorithm>
#include <tuple>

#include "convert/closed_mesh.h"

namespace heliodon::convert {

MeshEdges mesh_edges(const Mesh& mesh) {
    struct Use {
        std::uint32_t a, b, use;
    };
    const std::vector<std::uint32_t> welded = weld(mesh);
    std::vector<Use> uses;
    uses.reserve(mesh.indices.size());
    for (std::uint32_t triangle = 0; triangle < mesh.triangle_count(); ++triangle) {
        const auto corner = [&](std::uint32_t i) { return welded[mesh.indices[3 * triangle + i % 3]]; };
        if (corner(0) == corner(1) || corner(1) == corner(2) || corner(2) == corner(0)) continue;
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t from = corner(i), to = corner(i + 1);
            uses.push_back({std::min(from, to), std::max(from, to), 2 * triangle + (from > to ? 1 : 0)});
        }
    }
    std::ranges::sort(uses, {}, [](const Use& use) { return std::tuple(use.a, use.b, use.use); });
    MeshEdges result;
    result.uses.reserve(uses.size());
    for (const Use& use : uses) {
        if (result.edges.empty() || result.edges.back().a != use.a || result.edges.back().b != use.b)
            result.edges.push_back({use.a, use.b, static_cast<std::uint32_t>(result.uses.size()), 0});
        ++result.edges.back().use_count;
        result.uses.push_back(use.use);
    }
    return result;
}

}  // namespace heliodon::convert
