#include "realtime/shadow_detail.h"

#include <algorithm>
#include <cmath>

namespace heliodon::realtime {
namespace {

/// The plane through `point` whose inner side `inward` points to.
glm::dvec4 plane_through(glm::dvec3 point, glm::dvec3 inward) { return {inward, -glm::dot(inward, point)}; }
double side(const glm::dvec4& plane, const glm::dvec3& p) { return glm::dot(glm::dvec3(plane), p) + plane.w; }

void append_box(std::vector<glm::dvec4>& planes, glm::dvec3 low, glm::dvec3 high) {
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 inward(0);
        inward[axis] = 1;
        planes.push_back(plane_through(low, inward));
        planes.push_back(plane_through(high, -inward));
    }
}

void append_camera(std::vector<glm::dvec4>& planes, const ShadowDetail& camera) {
    const glm::dvec3 forward(camera.forward), eye(camera.position);
    const glm::dvec3 right = glm::dvec3(camera.ray_dx) * (0.5 * camera.width), up = glm::dvec3(camera.ray_dy) * (0.5 * camera.height);
    // A side's plane holds the eye; points beside it have |dot(axis, p)| = |axis|² · depth.
    for (const glm::dvec3& axis : {right, up})
        for (const double sign : {1.0, -1.0}) planes.push_back(plane_through(eye, glm::dot(axis, axis) * forward + sign * axis));
    planes.push_back(plane_through(eye + double(camera.near_m) * forward, forward));
}

/// Calls `visit` with the corners of the convex body that the planes bound: on each plane, of a square larger than
/// the body what the other planes leave. `size` metres hold the body, which begins at `middle`.
template <typename Visit>
void visit_corners(const std::vector<glm::dvec4>& planes, glm::dvec3 middle, double size, const Visit& visit) {
    const double rounding = 1e-9 * size;  // flat bodies stay
    std::vector<glm::dvec3> polygon, rest;
    for (const glm::dvec4& own : planes) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(own));
        const glm::dvec3 foot = middle - normal * (side(own, middle) / glm::length(glm::dvec3(own)));
        if (glm::distance(foot, middle) > size) continue;
        const glm::dvec3 u = glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        const glm::dvec3 v = glm::cross(normal, u);
        polygon = {foot + 2 * size * (u + v), foot + 2 * size * (u - v), foot - 2 * size * (u + v), foot + 2 * size * (v - u)};
        for (const glm::dvec4& plane : planes) {
            if (&plane == &own || polygon.empty()) continue;
            const double allowed = -rounding * glm::length(glm::dvec3(plane));
            rest.clear();
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const glm::dvec3 &from = polygon[i == 0 ? polygon.size() - 1 : i - 1], &to = polygon[i];
                const double before = side(plane, from), after = side(plane, to);
                if ((before < allowed) != (after < allowed)) rest.push_back(glm::mix(from, to, before / (before - after)));
                if (after >= allowed) rest.push_back(to);
            }
            std::swap(polygon, rest);
        }
        for (const glm::dvec3& corner : polygon) visit(corner);
    }
}

}  // namespace

ShadowDetail shadow_detail(const shading::FrameData& camera, const Bounds& scene) {
    ShadowDetail detail;
    detail.position = camera.position;
    detail.forward = camera.forward;
    detail.ray_dx = camera.ray_dx;
    detail.ray_dy = camera.ray_dy;
    detail.width = static_cast<int>(camera.width);
    detail.height = static_cast<int>(camera.height);
    detail.near_m = camera.near_m;
    if (!scene.empty()) detail.low = scene.min, detail.high = scene.max;
    return detail;
}

double texels_wanted(const ShadowFrustum& view, const ShadowDetail& detail) {
    const glm::dvec3 low(detail.low), high(detail.high), middle = 0.5 * (low + high);
    const double size = std::max(glm::distance(low, high), 1e-6);
    std::vector<glm::dvec4> planes = view.planes;
    append_box(planes, low, high);
    double wanted = 0;
    if (detail.voxel_m > 0)
        visit_corners(planes, middle, size, [&](const glm::dvec3& p) {
            wanted = std::max(wanted, 2 * side(view.half_width, p) / double(detail.voxel_m));
        });
    append_camera(planes, detail);
    // Texel over pixel is a quotient of linear functions: the most of it is at a corner.
    const glm::dvec4 depth = plane_through(detail.position, detail.forward);
    const double pixel = std::min(glm::length(detail.ray_dx), glm::length(detail.ray_dy));  // at depth 1
    visit_corners(planes, middle, size, [&](const glm::dvec3& p) {
        wanted = std::max(wanted, 2 * side(view.half_width, p) / (pixel * std::max(side(depth, p), double(detail.near_m))));
    });
    return wanted;
}

}  // namespace heliodon::realtime
