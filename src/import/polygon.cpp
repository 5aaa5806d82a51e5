#include "import/polygon.h"

#include <cmath>
#include <glm/glm.hpp>
#include <numeric>

namespace heliodon::import {
namespace {

double area(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool inside(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0 && p != a && p != b && p != c;
}

/// The polygon in its own plane, counter-clockwise: dropped along the largest axis of Newell's normal.
std::vector<glm::dvec2> flattened(std::span<const glm::vec3> polygon) {
    glm::dvec3 normal(0);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 a(polygon[i]), b(polygon[(i + 1) % polygon.size()]);
        normal += glm::dvec3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
    }
    int axis = 0;
    for (int c = 1; c < 3; ++c)
        if (std::abs(normal[c]) > std::abs(normal[axis])) axis = c;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double sign = normal[axis] < 0 ? -1 : 1;
    std::vector<glm::dvec2> flat;
    for (const glm::vec3& p : polygon) flat.push_back({p[u], sign * p[v]});
    return flat;
}

bool is_ear(const std::vector<glm::dvec2>& flat, const std::vector<std::uint32_t>& left, std::size_t at) {
    const std::size_t count = left.size();
    const glm::dvec2 a = flat[left[(at + count - 1) % count]], b = flat[left[at]], c = flat[left[(at + 1) % count]];
    if (area(a, b, c) <= 0) return false;
    for (std::size_t i = 2; i + 1 < count; ++i)
        if (inside(flat[left[(at + i) % count]], a, b, c)) return false;
    return true;
}

}  // namespace

std::vector<std::uint32_t> triangulate(std::span<const glm::vec3> polygon) {
    std::vector<std::uint32_t> left(polygon.size()), triangles;
    std::iota(left.begin(), left.end(), 0u);
    if (polygon.size() > 3) {
        const std::vector<glm::dvec2> flat = flattened(polygon);
        std::size_t at = 1, refused = 0;
        while (left.size() > 3 && refused < left.size()) {
            const std::size_t count = left.size();
            at %= count;
            if (is_ear(flat, left, at)) {
                triangles.insert(triangles.end(), {left[(at + count - 1) % count], left[at], left[(at + 1) % count]});
                left.erase(left.begin() + std::ptrdiff_t(at));
                refused = 0;
            } else {
                ++at;
                ++refused;
            }
        }
    }
    for (std::size_t i = 1; i + 1 < left.size(); ++i)
        triangles.insert(triangles.end(), {left[0], left[i], left[i + 1]});
    return triangles;
}

}  // namespace heliodon::import
