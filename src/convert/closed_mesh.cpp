#include "convert/closed_mesh.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

namespace heliodon::convert {
namespace {

using Indices = std::vector<std::uint32_t>;

/// Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators", mix64 variant 13.
std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

std::uint64_t hash(glm::vec3 p) {
    p += 0.0f;  // −0 and 0 are one place
    const auto bits = [](float x) { return std::uint64_t{std::bit_cast<std::uint32_t>(x)}; };
    return mix(mix(bits(p.x) << 32 | bits(p.y)) + bits(p.z));
}

}  // namespace

Indices weld(const Mesh& mesh) {
    constexpr std::uint32_t none = 0xffffffffu;
    const std::uint64_t mask = std::bit_ceil(2 * mesh.positions.size() + 1) - 1;
    Indices table(mask + 1, none), first(mesh.positions.size());
    for (std::uint32_t i = 0; i < first.size(); ++i) {
        std::uint64_t slot = hash(mesh.positions[i]) & mask;
        while (table[slot] != none && mesh.positions[table[slot]] != mesh.positions[i]) slot = (slot + 1) & mask;
        if (table[slot] == none) table[slot] = i;
        first[i] = table[slot];
    }
    return first;
}

namespace {

/// The triangles with three different corners.
Indices proper_triangles(const Mesh& mesh) {
    const Indices welded = weld(mesh);
    Indices triangles;
    triangles.reserve(mesh.indices.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t a = welded[mesh.indices[i]], b = welded[mesh.indices[i + 1]], c = welded[mesh.indices[i + 2]];
        if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
    }
    return triangles;
}

/// Sets of vertices that edges connect.
class Pieces {
public:
    explicit Pieces(std::size_t vertices) : parents_(vertices) { std::iota(parents_.begin(), parents_.end(), 0u); }
    void join(std::uint32_t a, std::uint32_t b) { parents_[of(a)] = of(b); }
    /// One vertex that stands for the set.
    std::uint32_t of(std::uint32_t vertex) {
        while (parents_[vertex] != vertex) vertex = parents_[vertex] = parents_[parents_[vertex]];
        return vertex;
    }

private:
    Indices parents_;
};

struct Edge {
    std::uint32_t low, high;  // vertices
    int uses;                 // in the direction from low to high, less those in the other
};

/// The edges used more often in one direction than in the other.
std::vector<Edge> boundary_edges(const Indices& triangles) {
    const auto each_edge = [&](const auto& visit) {
        for (std::size_t i = 0; i < triangles.size(); i += 3)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = triangles[i + k], b = triangles[i + (k + 1) % 3];
                visit(Edge{std::min(a, b), std::max(a, b), a < b ? 1 : -1});
            }
    };
    // A sieve: opposite uses of an edge add opposite random numbers to its sum, so that a sum stays at zero where all
    // its edges cancel (and elsewhere with a chance of 2⁻⁴⁷). Few edges are left to look at.
    constexpr std::size_t sums_count = 1 << 16;
    std::vector<std::uint64_t> sums(sums_count);
    const auto key = [](const Edge& edge) { return mix(std::uint64_t{edge.low} << 32 | edge.high); };
    each_edge([&](const Edge& edge) {
        const std::uint64_t k = key(edge);
        sums[k % sums_count] += edge.uses > 0 ? k : 0 - k;
    });
    std::vector<Edge> edges;
    each_edge([&](const Edge& edge) {
        if (sums[key(edge) % sums_count] != 0) edges.push_back(edge);
    });
    const auto ends = [](const Edge& edge) { return std::pair(edge.low, edge.high); };
    std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return ends(a) < ends(b); });
    std::vector<Edge> unbalanced;
    for (const Edge& edge : edges) {
        if (!unbalanced.empty() && ends(unbalanced.back()) == ends(edge)) unbalanced.back().uses += edge.uses;
        else unbalanced.push_back(edge);
    }
    std::erase_if(unbalanced, [](const Edge& edge) { return edge.uses == 0; });
    return unbalanced;
}

/// No less than the area, m², of surfaces that would fill the holes.
double hole_area(const Mesh& mesh, const Indices& triangles) {
    const std::vector<Edge> edges = boundary_edges(triangles);
    if (edges.empty()) return 0;
    Pieces rims(mesh.positions.size());
    for (const Edge& edge : edges) rims.join(edge.low, edge.high);
    std::vector<double> rim_lengths(mesh.positions.size());
    for (const Edge& edge : edges) {
        const glm::dvec3 a(mesh.positions[edge.low]), b(mesh.positions[edge.high]);
        rim_lengths[rims.of(edge.low)] += std::abs(edge.uses) * glm::length(b - a);
    }
    // The isoperimetric inequality of surfaces spanned by a curve in space (Carleman 1921): A ≤ L² / 4π.
    return std::transform_reduce(rim_lengths.begin(), rim_lengths.end(), 0.0, std::plus<>(),
                                 [](double length) { return length * length / (4 * std::numbers::pi); });
}

}  // namespace

bool is_closed(const Mesh& mesh) {
    const Indices triangles = proper_triangles(mesh);
    Pieces pieces(mesh.positions.size());
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        pieces.join(triangles[i], triangles[i + 1]);
        pieces.join(triangles[i], triangles[i + 2]);
    }
    struct Measure {
        double area = 0, volume = 0;
    };
    std::vector<Measure> measures(mesh.positions.size());
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const std::uint32_t piece = pieces.of(triangles[i]);
        const glm::dvec3 origin(mesh.positions[piece]);  // near the piece: far from the world's, digits would cancel
        const glm::dvec3 a = glm::dvec3(mesh.positions[triangles[i]]) - origin;
        const glm::dvec3 b = glm::dvec3(mesh.positions[triangles[i + 1]]) - origin;
        const glm::dvec3 c = glm::dvec3(mesh.positions[triangles[i + 2]]) - origin;
        measures[piece].area += glm::length(glm::cross(b - a, c - a)) / 2;
        measures[piece].volume += glm::dot(a, glm::cross(b, c)) / 6;  // the divergence theorem
    }
    double area = 0, inward = 0;
    for (const Measure& measure : measures) {
        area += measure.area;
        if (!(measure.volume > 0)) inward += measure.area;
    }
    constexpr double largest_open_share = 1e-3;
    return inward + hole_area(mesh, triangles) < largest_open_share * area;
}

}  // namespace heliodon::convert
