#include "trace/embree_shapes.h"

#include <cmath>
#include <limits>
#include <utility>

namespace heliodon::trace {
namespace {

struct Crossing {
    double t;
    glm::dvec3 normal;  // object space, outward
    double u, v;
};

/// Calls `accept(Crossing)` for each crossing of the line with the shape, nearest first, until it returns true.
template <class Accept>
void cross_sphere(const Sphere& sphere, const glm::dvec3& origin, const glm::dvec3& direction, Accept&& accept) {
    // Double precision: the float discriminant of a small sphere far away has no correct digit.
    const glm::dvec3 offset = origin - glm::dvec3(sphere.center);
    const double radius = sphere.radius;
    const double a = glm::dot(direction, direction);
    const double b = -glm::dot(offset, direction);
    const glm::dvec3 closest = offset + (b / a) * direction;
    const double discriminant = radius * radius - glm::dot(closest, closest);
    if (!(discriminant >= 0)) return;
    const double c = glm::dot(offset, offset) - radius * radius;
    const double q = b + std::copysign(std::sqrt(a * discriminant), b);
    double near = c / q, far = q / a;
    if (q == 0) near = far = 0;
    if (near > far) std::swap(near, far);
    for (const double t : {near, far})
        if (accept(Crossing{t, (offset + t * direction) / radius, 0, 0})) return;
}

template <class Accept>
void cross_disk(const Disk& disk, const glm::dvec3& origin, const glm::dvec3& direction, Accept&& accept) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(disk.normal));
    const double t = glm::dot(glm::dvec3(disk.center) - origin, normal) / glm::dot(direction, normal);
    if (!std::isfinite(t)) return;
    const glm::dvec3 tangent = disk_tangent(glm::vec3(normal)), bitangent = glm::cross(normal, tangent);
    const glm::dvec3 point = (origin + t * direction - glm::dvec3(disk.center)) / static_cast<double>(disk.radius);
    const double u = glm::dot(point, tangent), v = glm::dot(point, bitangent);
    if (u * u + v * v <= 1) accept(Crossing{t, normal, u, v});
}

template <class Accept>
void cross_shape(const Shape& shape, const glm::dvec3& origin, const glm::dvec3& direction, Accept&& accept) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) cross_sphere(*sphere, origin, direction, accept);
    if (const auto* disk = std::get_if<Disk>(&shape)) cross_disk(*disk, origin, direction, accept);
}

void shape_bounds(const RTCBoundsFunctionArguments* arguments) {
    const Shape& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
    const Bounds exact = bounds(shape);
    // A little outward, since the crossing itself is computed in double precision.
    const glm::vec3 margin = 1e-6f * (glm::abs(exact.center()) + glm::vec3(exact.diagonal()));
    const glm::vec3 lower = exact.min - margin, upper = exact.max + margin;
    *arguments->bounds_o = {lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, 0};
}

/// Calls `accept(lane, crossing)` for the crossings of each ray of a packet, as cross_shape does.
template <class Accept>
void cross_packet(const Shape& shape, const int* valid, RTCRayN* rays, unsigned count, Accept&& accept) {
    for (unsigned i = 0; i < count; ++i) {
        if (!valid[i]) continue;
        const glm::dvec3 origin{RTCRayN_org_x(rays, count, i), RTCRayN_org_y(rays, count, i),
                                RTCRayN_org_z(rays, count, i)};
        const glm::dvec3 direction{RTCRayN_dir_x(rays, count, i), RTCRayN_dir_y(rays, count, i),
                                   RTCRayN_dir_z(rays, count, i)};
        cross_shape(shape, origin, direction, [&](const Crossing& crossing) {
            const auto t = static_cast<float>(crossing.t);
            if (!(t > RTCRayN_tnear(rays, count, i) && t <= RTCRayN_tfar(rays, count, i))) return false;
            accept(i, crossing);
            return true;
        });
    }
}

void shape_intersect(const RTCIntersectFunctionNArguments* arguments) {
    const unsigned n = arguments->N;
    RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, n);
    RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, n);
    const Shape& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
    cross_packet(shape, arguments->valid, rays, n, [&](unsigned i, const Crossing& crossing) {
        RTCRayN_tfar(rays, n, i) = static_cast<float>(crossing.t);
        RTCHitN_u(hits, n, i) = static_cast<float>(crossing.u);
        RTCHitN_v(hits, n, i) = static_cast<float>(crossing.v);
        RTCHitN_Ng_x(hits, n, i) = static_cast<float>(crossing.normal.x);
        RTCHitN_Ng_y(hits, n, i) = static_cast<float>(crossing.normal.y);
        RTCHitN_Ng_z(hits, n, i) = static_cast<float>(crossing.normal.z);
        RTCHitN_primID(hits, n, i) = arguments->primID;
        RTCHitN_geomID(hits, n, i) = 0;
        RTCHitN_instID(hits, n, i, 0) = arguments->context->instID[0];
    });
}

void shape_occluded(const RTCOccludedFunctionNArguments* arguments) {
    const unsigned n = arguments->N;
    const Shape& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
    cross_packet(shape, arguments->valid, arguments->ray, n, [&](unsigned i, const Crossing&) {
        RTCRayN_tfar(arguments->ray, n, i) = -std::numeric_limits<float>::infinity();
    });
}

}  // namespace

void answer_exactly(RTCGeometry geometry, const Shape& shape) {
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, const_cast<Shape*>(&shape));  // only ever read
    rtcSetGeometryBoundsFunction(geometry, shape_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, shape_intersect);
    rtcSetGeometryOccludedFunction(geometry, shape_occluded);
}

}  // namespace heliodon::trace
