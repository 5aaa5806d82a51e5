#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math.h"
#include "core/padded_array.h"

namespace heliodon {

/// Indexed triangles. Attribute arrays are empty or as long as `positions`. Front faces are
/// counter-clockwise; a mesh faces outward. This is the one host copy: the tracer reads these arrays in
/// place and the GPU scene uploads them.
struct Mesh {
    PaddedArray<glm::vec3> positions;     ///< metres, object space
    PaddedArray<glm::vec3> normals;       ///< unit length
    PaddedArray<glm::vec4> tangents;      ///< xyz unit length, w = ±1: bitangent = w · cross(normal, tangent)
    PaddedArray<glm::vec2> texcoords[2];  ///< glTF's convention: v runs down from the picture's top
    PaddedArray<glm::vec4> colors;        ///< linear, multiplies the base colour
    PaddedArray<std::uint32_t> indices;   ///< three a triangle

    [[nodiscard]] std::size_t triangle_count() const { return indices.size() / 3; }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] Bounds bounds() const;
};

/// Parallelogram; its front side is u × v.
struct Quad {
    glm::vec3 origin{0}, u{1, 0, 0}, v{0, 0, 1};
};
struct Disk {
    glm::vec3 center{0}, normal{0, 1, 0};
    float radius = 1;
};
struct Box {
    glm::vec3 min{0}, max{1};
};
struct Sphere {
    glm::vec3 center{0};
    float radius = 1;
};

/// A shape the path tracer intersects exactly; the real-time engine draws its tessellation.
using Shape = std::variant<Quad, Disk, Box, Sphere>;

/// A mesh, or an exact shape with `mesh` its tessellation.
struct Geometry {
    std::string name;
    Mesh mesh;
    std::optional<Shape> shape;
    Bounds bounds;  ///< of the mesh (and of the exact shape), object space
};

/// Triangles for `shape`: quads and boxes exactly; disks and spheres within `segments` round the full
/// circle (a sphere has segments/2 rings), with exact normals, tangents and texture coordinates.
[[nodiscard]] Mesh tessellate(const Shape& shape, int segments);

}  // namespace heliodon
