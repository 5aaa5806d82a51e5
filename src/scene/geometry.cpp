#include "scene/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace heliodon {
namespace {

void add_vertex(Mesh& mesh, glm::vec3 position, glm::vec3 normal, glm::vec3 tangent, glm::vec2 texcoord) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
    mesh.tangents.emplace_back(tangent, 1.0f);
    mesh.texcoords[0].push_back(texcoord);
}

void add_triangle(Mesh& mesh, std::size_t a, std::size_t b, std::size_t c) {
    for (const std::size_t index : {a, b, c}) mesh.indices.push_back(static_cast<std::uint32_t>(index));
}

void add_quad(Mesh& mesh, const Quad& quad) {
    const std::size_t first = mesh.positions.size();
    const glm::vec3 normal = glm::normalize(glm::cross(quad.u, quad.v));
    const glm::vec3 tangent = glm::normalize(quad.u);
    add_vertex(mesh, quad.origin, normal, tangent, {0, 1});
    add_vertex(mesh, quad.origin + quad.u, normal, tangent, {1, 1});
    add_vertex(mesh, quad.origin + quad.u + quad.v, normal, tangent, {1, 0});
    add_vertex(mesh, quad.origin + quad.v, normal, tangent, {0, 0});
    add_triangle(mesh, first, first + 1, first + 2);
    add_triangle(mesh, first, first + 2, first + 3);
}

Mesh triangles(const Quad& quad, int) {
    Mesh mesh;
    add_quad(mesh, quad);
    return mesh;
}

Mesh triangles(const Box& box, int) {
    const glm::vec3 a = box.min, b = box.max, size = box.max - box.min;
    const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    Mesh mesh;
    add_quad(mesh, {{b.x, a.y, b.z}, -z, y});  // +X
    add_quad(mesh, {a, z, y});                 // −X
    add_quad(mesh, {{a.x, b.y, b.z}, x, -z});  // +Y
    add_quad(mesh, {a, x, z});                 // −Y
    add_quad(mesh, {{a.x, a.y, b.z}, x, y});   // +Z
    add_quad(mesh, {{b.x, a.y, a.z}, -x, y});  // −Z
    // Sums of rounded edges miss their corner: faces meet bit by bit, so that the mesh is closed.
    for (glm::vec3& p : mesh.positions)
        for (int c = 0; c < 3; ++c) p[c] = std::abs(p[c] - a[c]) < std::abs(p[c] - b[c]) ? a[c] : b[c];
    return mesh;
}

Mesh triangles(const Disk& disk, int segments) {
    const glm::vec3 normal = glm::normalize(disk.normal);
    const glm::vec3 tangent = disk_tangent(normal), bitangent = glm::cross(normal, tangent);
    Mesh mesh;
    add_vertex(mesh, disk.center, normal, tangent, {0.5f, 0.5f});
    for (int i = 0; i < segments; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / segments;
        const float x = static_cast<float>(std::cos(angle)), y = static_cast<float>(std::sin(angle));
        add_vertex(mesh, disk.center + disk.radius * (x * tangent + y * bitangent), normal, tangent,
                   {0.5f + 0.5f * x, 0.5f - 0.5f * y});
    }
    for (int i = 0; i < segments; ++i) add_triangle(mesh, 0, 1 + i, 1 + (i + 1) % segments);
    return mesh;
}

/// Rings of segments + 1 vertices: the seam has two texture coordinates, and a pole one vertex a segment
/// with the coordinate of its triangle's middle.
Mesh triangles(const Sphere& sphere, int segments) {
    const int rings = std::max(2, segments / 2);
    Mesh mesh;
    for (int ring = 0; ring <= rings; ++ring) {
        const bool pole = ring == 0 || ring == rings;
        const double theta = std::numbers::pi * ring / rings;
        const double sin_theta = pole ? 0.0 : std::sin(theta);
        for (int segment = 0; segment <= segments; ++segment) {
            const double u = (segment + (pole ? 0.5 : 0.0)) / segments;
            const double phi = 2.0 * std::numbers::pi * std::fmod(u, 1.0);  // the seam closes bit by bit
            const glm::vec3 normal(glm::dvec3(-sin_theta * std::sin(phi), std::cos(theta), -sin_theta * std::cos(phi)));
            const glm::vec3 tangent(glm::dvec3(-std::cos(phi), 0, std::sin(phi)));
            add_vertex(mesh, sphere.center + sphere.radius * normal, normal, tangent,
                       {static_cast<float>(u), static_cast<float>(ring) / static_cast<float>(rings)});
        }
    }
    for (int ring = 0; ring < rings; ++ring) {
        for (int segment = 0; segment < segments; ++segment) {
            const std::size_t upper = static_cast<std::size_t>(ring) * (segments + 1) + segment;
            const std::size_t lower = upper + segments + 1;
            const bool last = ring + 1 == rings;
            if (!last) add_triangle(mesh, upper, lower, lower + 1);
            if (ring > 0) add_triangle(mesh, upper, last ? lower : lower + 1, upper + 1);
        }
    }
    return mesh;
}

Bounds exact_bounds(const Quad& quad) {
    Bounds result;
    for (const glm::vec3 corner :
         {quad.origin, quad.origin + quad.u, quad.origin + quad.v, quad.origin + quad.u + quad.v})
        result.include(corner);
    return result;
}

Bounds exact_bounds(const Disk& disk) {
    const glm::vec3 normal = glm::normalize(disk.normal);
    const glm::vec3 half = disk.radius * glm::sqrt(glm::max(glm::vec3(0), 1.0f - normal * normal));
    return {disk.center - half, disk.center + half};
}

Bounds exact_bounds(const Box& box) {
    return {box.min, box.max};
}

Bounds exact_bounds(const Sphere& sphere) {
    return {sphere.center - sphere.radius, sphere.center + sphere.radius};
}

template <class T>
std::size_t bytes_of(const PaddedArray<T>& array) {
    return array.size() * sizeof(T);
}

}  // namespace

std::size_t Mesh::bytes() const {
    return bytes_of(positions) + bytes_of(normals) + bytes_of(tangents) + bytes_of(texcoords[0]) +
           bytes_of(texcoords[1]) + bytes_of(colors) + bytes_of(indices);
}

Bounds Mesh::bounds() const {
    Bounds result;
    for (const glm::vec3& position : positions) result.include(position);
    return result;
}

glm::vec3 disk_tangent(glm::vec3 normal) {
    const bool level = std::abs(normal.y) > 0.9999f;
    const glm::vec3 up = level ? glm::vec3(0, 0, normal.y > 0 ? -1 : 1) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(up, normal));
}

Bounds bounds(const Shape& shape) {
    return std::visit([](const auto& exact) { return exact_bounds(exact); }, shape);
}

Mesh tessellate(const Shape& shape, int segments) {
    constexpr int fewest = 3, most = 4096;
    const int clamped = std::clamp(segments, fewest, most);
    return std::visit([clamped](const auto& exact) { return triangles(exact, clamped); }, shape);
}

}  // namespace heliodon
