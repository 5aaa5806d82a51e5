#include "convert/closed_mesh.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace heliodon::convert {
namespace {

/// Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators", mix64 variant 13 (a bijection).
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

/// For each vertex the first one at its position.
std::vector<std::uint32_t> weld(const Mesh& mesh) {
    constexpr std::uint32_t none = 0xffffffffu;
    const std::uint64_t mask = std::bit_ceil(2 * mesh.positions.size() + 1) - 1;
    std::vector<std::uint32_t> table(mask + 1, none), first(mesh.positions.size());
    for (std::uint32_t i = 0; i < first.size(); ++i) {
        std::uint64_t slot = hash(mesh.positions[i]) & mask;
        while (table[slot] != none && mesh.positions[table[slot]] != mesh.positions[i]) slot = (slot + 1) & mask;
        if (table[slot] == none) table[slot] = i;
        first[i] = table[slot];
    }
    return first;
}

/// Calls `visit(a, b, c)` for each triangle with three different corners.
template <class Visit>
void each_triangle(const Mesh& mesh, const std::vector<std::uint32_t>& welded, const Visit& visit) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t a = welded[mesh.indices[i]], b = welded[mesh.indices[i + 1]], c = welded[mesh.indices[i + 2]];
        if (a != b && b != c && c != a) visit(a, b, c);
    }
}

/// The oriented edge from `a` to `b` as a random number, the negative of that from `b` to `a`: a sum over edges is
/// zero where each edge's uses cancel, and almost never elsewhere.
std::uint64_t edge(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = mix(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b));
    return a < b ? key : 0 - key;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t vertex) {
    while (parents[vertex] != vertex) vertex = parents[vertex] = parents[parents[vertex]];
    return vertex;
}

}  // namespace

bool is_closed(const Mesh& mesh) {
    const std::vector<std::uint32_t> welded = weld(mesh);
    std::uint64_t boundary = 0;
    each_triangle(mesh, welded, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        boundary += edge(a, b) + edge(b, c) + edge(c, a);
    });
    if (boundary != 0) return false;

    std::vector<std::uint32_t> parents(welded.size());
    std::iota(parents.begin(), parents.end(), 0u);
    each_triangle(mesh, welded, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const std::uint32_t root = root_of(parents, a);
        parents[root_of(parents, b)] = root;
        parents[root_of(parents, c)] = root;
    });
    // The divergence theorem, about a point of each piece: far from the origin nothing cancels.
    std::vector<double> six_volumes(welded.size());
    each_triangle(mesh, welded, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const std::uint32_t root = root_of(parents, a);
        const glm::dvec3 origin(mesh.positions[root]);
        const auto from_origin = [&](std::uint32_t i) { return glm::dvec3(mesh.positions[i]) - origin; };
        six_volumes[root] += glm::dot(from_origin(a), glm::cross(from_origin(b), from_origin(c)));
    });
    bool any = false, all_positive = true;
    each_triangle(mesh, welded, [&](std::uint32_t a, std::uint32_t, std::uint32_t) {
        any = true;
        all_positive &= six_volumes[root_of(parents, a)] > 0;
    });
    return any && all_positive;
}

}  // namespace heliodon::convert
