#include "import/mesh_completion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>

#include "import/import.h"

namespace heliodon::import {
namespace {

constexpr std::uint32_t unset = 0xffffffffu;

struct PositionHash {
    std::size_t operator()(const glm::vec3& p) const {
        std::uint64_t hash = 0x9e3779b97f4a7c15ull;
        for (int c = 0; c < 3; ++c) {
            hash ^= std::bit_cast<std::uint32_t>(p[c] + 0.0f);  // + 0: −0 and 0 are the same place
            hash *= 0xff51afd7ed558ccdull;
            hash ^= hash >> 32;
        }
        return hash;
    }
};

/// The place of each vertex: vertices that coincide exactly share a number.
std::vector<std::uint32_t> number_places(const Mesh& mesh, std::uint32_t& count) {
    std::unordered_map<glm::vec3, std::uint32_t, PositionHash> places;
    places.reserve(mesh.positions.size());
    std::vector<std::uint32_t> place(mesh.positions.size());
    for (std::size_t v = 0; v < place.size(); ++v)
        place[v] = places.try_emplace(mesh.positions[v], std::uint32_t(places.size())).first->second;
    count = std::uint32_t(places.size());
    return place;
}

glm::vec3 face_normal(const Mesh& mesh, std::size_t face) {
    const glm::dvec3 a(mesh.positions[mesh.indices[face * 3]]), b(mesh.positions[mesh.indices[face * 3 + 1]]),
        c(mesh.positions[mesh.indices[face * 3 + 2]]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    return length > 0 ? glm::vec3(normal / length) : glm::vec3(0);
}

/// The face's angle at one of its corners.
float corner_angle(const Mesh& mesh, std::size_t corner) {
    const std::size_t face = corner / 3 * 3;
    // Double precision: products of very long or very short single-precision edges leave its range.
    const glm::dvec3 here(mesh.positions[mesh.indices[corner]]);
    const glm::dvec3 u = glm::dvec3(mesh.positions[mesh.indices[face + (corner + 1) % 3]]) - here;
    const glm::dvec3 v = glm::dvec3(mesh.positions[mesh.indices[face + (corner + 2) % 3]]) - here;
    return float(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
}

glm::vec3 any_perpendicular(glm::vec3 normal) {
    const glm::vec3 axis = std::abs(normal.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(axis, normal));
}

glm::vec3 normalized_or(glm::vec3 vector, glm::vec3 fallback) {
    const double length = glm::length(glm::dvec3(vector));
    return length > 1e-20 && std::isfinite(length) ? glm::vec3(glm::dvec3(vector) / length) : fallback;
}

/// The corners that meet at each place, as one list with offsets.
struct CornersOfPlaces {
    std::vector<std::uint32_t> begin, corners;
};

CornersOfPlaces collect_corners(const Mesh& mesh, const std::vector<std::uint32_t>& place, std::uint32_t count) {
    CornersOfPlaces result{std::vector<std::uint32_t>(count + 1, 0), std::vector<std::uint32_t>(mesh.indices.size())};
    for (const std::uint32_t vertex : mesh.indices) ++result.begin[place[vertex] + 1];
    std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
    std::vector<std::uint32_t> next(result.begin.begin(), result.begin.end() - 1);
    for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner)
        result.corners[next[place[mesh.indices[corner]]]++] = std::uint32_t(corner);
    return result;
}

/// One normal a corner, from the faces round its place that are within the crease angle of its own.
std::vector<glm::vec3> corner_normals(const Mesh& mesh, float crease_rad) {
    std::vector<glm::vec3> faces(mesh.triangle_count());
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = face_normal(mesh, f);
    std::vector<glm::vec3> normals(mesh.indices.size());
    if (crease_rad <= 0) {
        for (std::size_t corner = 0; corner < normals.size(); ++corner) normals[corner] = faces[corner / 3];
        return normals;
    }
    std::uint32_t place_count = 0;
    const std::vector<std::uint32_t> place = number_places(mesh, place_count);
    const CornersOfPlaces at = collect_corners(mesh, place, place_count);
    std::vector<float> angles(mesh.indices.size());
    for (std::size_t corner = 0; corner < angles.size(); ++corner) angles[corner] = corner_angle(mesh, corner);
    const float least_cosine = std::cos(crease_rad);
    // Comparing every pair costs the square of the faces at a place; past this many they are all averaged.
    constexpr std::uint32_t most_compared = 2048;
    for (std::uint32_t p = 0; p < place_count; ++p) {
        const std::span<const std::uint32_t> corners(at.corners.data() + at.begin[p], at.begin[p + 1] - at.begin[p]);
        const bool compare = corners.size() <= most_compared;
        glm::vec3 all(0);
        for (const std::uint32_t other : corners) all += angles[other] * faces[other / 3];
        for (const std::uint32_t corner : corners) {
            glm::vec3 sum = compare ? glm::vec3(0) : all;
            for (std::size_t j = 0; compare && j < corners.size(); ++j)
                if (glm::dot(faces[corner / 3], faces[corners[j] / 3]) >= least_cosine)
                    sum += angles[corners[j]] * faces[corners[j] / 3];
            normals[corner] = normalized_or(sum, faces[corner / 3]);
        }
    }
    return normals;
}

template <class T>
void gather(PaddedArray<T>& values, const std::vector<std::uint32_t>& sources) {
    if (values.empty()) return;
    PaddedArray<T> result(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) result[i] = values[sources[i]];
    values = std::move(result);
}

}  // namespace

void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& sources) {
    gather(mesh.positions, sources);
    gather(mesh.normals, sources);
    gather(mesh.tangents, sources);
    for (auto& set : mesh.texcoords) gather(set, sources);
    gather(mesh.colors, sources);
}

void make_normals(Mesh& mesh, float crease_rad) {
    const std::vector<glm::vec3> corners = corner_normals(mesh, crease_rad);
    // Each old vertex becomes a chain of new ones, one for each different normal of its corners.
    std::vector<std::uint32_t> sources, next_in_chain, first(mesh.positions.size(), unset);
    std::vector<glm::vec3> normals;
    sources.reserve(mesh.positions.size());
    for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
        const std::uint32_t vertex = mesh.indices[corner];
        std::uint32_t found = first[vertex];
        while (found != unset && normals[found] != corners[corner]) found = next_in_chain[found];
        if (found == unset) {
            found = std::uint32_t(sources.size());
            sources.push_back(vertex);
            normals.push_back(corners[corner]);
            next_in_chain.push_back(first[vertex]);
            first[vertex] = found;
        }
        mesh.indices[corner] = found;
    }
    mesh.normals.clear();
    mesh.tangents.clear();
    gather_vertices(mesh, sources);
    mesh.normals.assign(normals.begin(), normals.end());
}

std::size_t repair_normals(Mesh& mesh) {
    constexpr double shortest = 1e-6;
    std::size_t replaced = 0;
    for (glm::vec3& normal : mesh.normals) {
        const double length = glm::length(glm::dvec3(normal));
        replaced += length < shortest;
        normal = length < shortest ? glm::vec3(0) : glm::vec3(glm::dvec3(normal) / length);
    }
    if (replaced == 0) return 0;
    std::vector<glm::vec3> sums(mesh.positions.size(), glm::vec3(0));
    for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner)
        sums[mesh.indices[corner]] += corner_angle(mesh, corner) * face_normal(mesh, corner / 3);
    for (std::size_t v = 0; v < mesh.normals.size(); ++v)
        if (mesh.normals[v] == glm::vec3(0)) mesh.normals[v] = normalized_or(sums[v], glm::vec3(0, 1, 0));
    return replaced;
}

void make_tangents(Mesh& mesh, int texcoord_set) {
    const PaddedArray<glm::vec2>& uv = mesh.texcoords[texcoord_set];
    if (mesh.normals.empty() || uv.empty()) return;
    std::vector<glm::vec3> tangents(mesh.positions.size(), glm::vec3(0)), bitangents(tangents);
    for (std::size_t face = 0; face < mesh.triangle_count(); ++face) {
        const std::uint32_t* v = &mesh.indices[face * 3];
        const glm::vec3 e1 = mesh.positions[v[1]] - mesh.positions[v[0]];
        const glm::vec3 e2 = mesh.positions[v[2]] - mesh.positions[v[0]];
        const glm::vec2 d1 = uv[v[1]] - uv[v[0]], d2 = uv[v[2]] - uv[v[0]];
        const float area = d1.x * d2.y - d2.x * d1.y;
        if (area == 0 || !std::isfinite(area)) continue;
        // dP/du and dP/dv of the face (Lengyel 2001); only the directions count, so 1/area gives its sign.
        const glm::vec3 along_u = normalized_or((e1 * d2.y - e2 * d1.y) * std::copysign(1.0f, area), glm::vec3(0));
        const glm::vec3 along_v = normalized_or((e2 * d1.x - e1 * d2.x) * std::copysign(1.0f, area), glm::vec3(0));
        for (int k = 0; k < 3; ++k) {
            const float angle = corner_angle(mesh, face * 3 + k);
            tangents[v[k]] += angle * along_u;
            bitangents[v[k]] += angle * along_v;
        }
    }
    mesh.tangents.resize(mesh.positions.size());
    for (std::size_t v = 0; v < tangents.size(); ++v) {
        const glm::vec3 n = mesh.normals[v];
        glm::vec3 t = tangents[v] - n * glm::dot(n, tangents[v]);
        t = glm::length(t) > 1e-6f ? glm::normalize(t) : any_perpendicular(n);
        // glTF's v runs down the picture while a normal map's green points up it, so that the bitangent is
        // against dP/dv: w · cross(n, t) = −dP/dv.
        const float handedness = glm::dot(glm::cross(n, t), bitangents[v]) > 0 ? -1.0f : 1.0f;
        mesh.tangents[v] = glm::vec4(t, handedness);
    }
}

std::size_t drop_degenerate_triangles(Mesh& mesh) {
    // Twice the area over the square of the longest side is height over side; 2^-24 is half a unit in the
    // last place of a coordinate as long as that side.
    constexpr double least_height = 5.9604644775390625e-8;
    std::size_t kept = 0;
    for (std::size_t face = 0; face < mesh.triangle_count(); ++face) {
        const std::uint32_t v[3] = {mesh.indices[face * 3], mesh.indices[face * 3 + 1], mesh.indices[face * 3 + 2]};
        const glm::dvec3 a(mesh.positions[v[0]]), b(mesh.positions[v[1]]), c(mesh.positions[v[2]]);
        const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
        if (glm::length(glm::cross(b - a, c - a)) <= least_height * longest) continue;
        std::copy(v, v + 3, mesh.indices.begin() + std::ptrdiff_t(kept++ * 3));
    }
    const std::size_t dropped = mesh.triangle_count() - kept;
    mesh.indices.resize(kept * 3);
    return dropped;
}

void drop_unused_vertices(Mesh& mesh) {
    std::vector<std::uint32_t> renumbered(mesh.positions.size(), unset);
    for (const std::uint32_t vertex : mesh.indices) renumbered[vertex] = 0;
    std::vector<std::uint32_t> sources;
    for (std::size_t v = 0; v < renumbered.size(); ++v)
        if (renumbered[v] == 0) {
            renumbered[v] = std::uint32_t(sources.size());
            sources.push_back(std::uint32_t(v));
        }
    if (sources.size() == mesh.positions.size()) return;
    for (std::uint32_t& vertex : mesh.indices) vertex = renumbered[vertex];
    gather_vertices(mesh, sources);
}

}  // namespace heliodon::import

namespace heliodon {

void complete_mesh(Mesh& mesh) {
    if (mesh.normals.empty()) import::make_normals(mesh, import::crease_angle_rad);
    if (mesh.tangents.empty()) import::make_tangents(mesh, 0);
}

}  // namespace heliodon
