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

/// Parallelogram; its front side is u × v. The point origin + s·u + t·v has texture coordinates (s, 1 − t) and
/// tangent u, so that a picture stands upright on a quad whose v points up.
struct Quad {
    glm::vec3 origin{0}, u{1, 0, 0}, v{0, 0, 1};
};
/// Its picture is centred: center + radius·(x·tangent + y·bitangent) has texture coordinates
/// ((1 + x)/2, (1 − y)/2), with the tangent of `disk_tangent(normal)` and bitangent = normal × tangent.
struct Disk {
    glm::vec3 center{0}, normal{0, 1, 0};
    float radius = 1;
};
/// Each face is a quad with a whole picture, upright on the four sides (+Y up); u of the top and bottom is +X.
struct Box {
    glm::vec3 min{0}, max{1};
};
/// Poles on ±Y. Texture coordinates (u, v) with φ = 2πu, θ = πv lie at the direction
/// (−sin θ sin φ, cos θ, −sin θ cos φ): the seam faces −Z. The tangent is (−cos φ, 0, sin φ).
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

/// The unit tangent that disks of this unit `normal` use: level where that is possible, +X for ±Y normals.
[[nodiscard]] glm::vec3 disk_tangent(glm::vec3 normal);
/// The exact box around `shape`.
[[nodiscard]] Bounds bounds(const Shape& shape);
/// Triangles for `shape`: quads and boxes exactly; disks and spheres within `segments` round the full
/// circle (a sphere has segments/2 rings), with exact normals, tangents and texture coordinates.
[[nodiscard]] Mesh tessellate(const Shape& shape, int segments);

}  // namespace heliodon
