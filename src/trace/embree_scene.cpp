#include "trace/embree_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

namespace heliodon::trace {
namespace {

constexpr unsigned opaque_mask = 1;       // instances that block every ray
constexpr unsigned translucent_mask = 2;  // instances whose material may let a shadow ray through

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
        const glm::dvec3 origin{RTCRayN_org_x(rays, count, i), RTCRayN_org_y(rays, count, i), RTCRayN_org_z(rays, count, i)};
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

RTCRay embree_ray(const shading::KernelRay& ray, unsigned mask) {
    RTCRay result{};
    result.org_x = ray.origin.x;
    result.org_y = ray.origin.y;
    result.org_z = ray.origin.z;
    result.dir_x = ray.direction.x;
    result.dir_y = ray.direction.y;
    result.dir_z = ray.direction.z;
    result.tnear = 0;
    result.tfar = ray.t_max;
    result.mask = mask;
    return result;
}

bool is_drawn(const convert::FlatScene& flat, std::uint32_t index) {
    const shading::InstanceData& instance = flat.instances()[index];
    return (instance.flags & shading::instance_flag_visible) && flat.geometries()[instance.geometry];
}

unsigned mask_of(const convert::FlatScene& flat, std::uint32_t index) {
    constexpr std::uint32_t alpha = shading::material_flag_alpha_mask | shading::material_flag_alpha_blend;
    return flat.materials()[flat.instances()[index].material].flags & alpha ? translucent_mask : opaque_mask;
}

}  // namespace

Result<void> EmbreeScene::open_device() {
    if (device_) return {};
    device_.reset(rtcNewDevice(nullptr));
    if (!device_)
        return fail("", fmt::format("cannot start Embree (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
    return {};
}

Result<void> EmbreeScene::take_geometry(const Geometry* geometry, Level& level) {
    level = {};
    if (!geometry || geometry->mesh.indices.empty()) return {};
    const Mesh& mesh = geometry->mesh;
    const bool exact = geometry->shape && (std::holds_alternative<Sphere>(*geometry->shape) ||
                                           std::holds_alternative<Disk>(*geometry->shape));
    if (exact) {
        level.shape = std::make_unique<Shape>(*geometry->shape);
        level.geometry.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
        rtcSetGeometryUserPrimitiveCount(level.geometry.get(), 1);
        rtcSetGeometryUserData(level.geometry.get(), level.shape.get());
        rtcSetGeometryBoundsFunction(level.geometry.get(), shape_bounds, nullptr);
        rtcSetGeometryIntersectFunction(level.geometry.get(), shape_intersect);
        rtcSetGeometryOccludedFunction(level.geometry.get(), shape_occluded);
    } else {
        const std::uint32_t highest = *std::max_element(mesh.indices.begin(), mesh.indices.end());
        if (highest >= mesh.positions.size())
            return fail(geometry->name,
                        fmt::format("expected vertex indices below {}, found {}", mesh.positions.size(), highest));
        level.geometry.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        // Shared, never copied: Mesh's arrays are padded for Embree's 16-byte reads.
        rtcSetSharedGeometryBuffer(level.geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   mesh.positions.data(), 0, sizeof(glm::vec3), mesh.positions.size());
        rtcSetSharedGeometryBuffer(level.geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.indices.data(), 0, 3 * sizeof(std::uint32_t), mesh.triangle_count());
    }
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE)
        return fail(geometry->name, fmt::format("Embree cannot take it (error {})", static_cast<int>(error)));
    return {};
}

void EmbreeScene::build_level(Level& level) {
    embree_answer_every_mask(level.geometry.get());
    rtcCommitGeometry(level.geometry.get());
    level.scene.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(level.scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometryByID(level.scene.get(), level.geometry.get(), 0);
    rtcCommitScene(level.scene.get());
}

bool EmbreeScene::place_instance(const convert::FlatScene& flat, std::uint32_t index) {
    const shading::InstanceData& data = flat.instances()[index];
    const Level& level = levels_[data.geometry];
    const bool drawn = is_drawn(flat, index) && level.geometry;
    const bool was_attached = instances_[index].attached;
    if (was_attached) rtcDetachGeometry(top_.get(), index);
    instances_[index] = {};
    if (!drawn) return was_attached;

    GeometryReference instance;
    if (level.scene) {
        instance.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
        rtcSetGeometryInstancedScene(instance.get(), level.scene.get());
        rtcSetGeometryTransform(instance.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                                glm::value_ptr(data.object_to_world));
    }
    const RTCGeometry placed = level.scene ? instance.get() : level.geometry.get();
    instances_[index] = {.mask = mask_of(flat, index), .attached = true, .direct = !level.scene};
    rtcSetGeometryMask(placed, instances_[index].mask);
    rtcCommitGeometry(placed);
    rtcAttachGeometryByID(top_.get(), placed, index);
    return true;
}

int EmbreeScene::build_instanced_levels(const convert::FlatScene& flat) {
    std::vector<int> users(levels_.size(), 0);
    const auto each_drawn = [&](auto&& visit) {
        for (std::uint32_t index = 0; index < instances_.size(); ++index)
            if (is_drawn(flat, index)) visit(flat.instances()[index]);
    };
    each_drawn([&](const shading::InstanceData& data) { ++users[data.geometry]; });
    int built = 0;
    each_drawn([&](const shading::InstanceData& data) {
        Level& level = levels_[data.geometry];
        if (!level.geometry || level.scene) return;
        const bool shape = flat.geometries()[data.geometry]->shape.has_value();
        if (!shape && users[data.geometry] == 1 && data.object_to_world == glm::mat4(1)) return;
        build_level(level);
        ++built;
    });
    return built;
}

Result<TraceUpdate> EmbreeScene::update(const convert::FlatScene& flat, const convert::FlatChanges& changes) {
    if (auto opened = open_device(); !opened) return tl::unexpected(opened.error());
    TraceUpdate result;
    const bool everything = changes.everything || !top_;
    if (everything) {
        instances_.clear();
        top_.reset(rtcNewScene(device_.get()));
        rtcSetSceneFlags(top_.get(), RTC_SCENE_FLAG_ROBUST);
        levels_.clear();
    }
    levels_.resize(flat.geometries().size());
    instances_.resize(flat.instances().size());

    std::vector<bool> rebuilt(levels_.size(), everything);
    std::vector<std::uint32_t> wanted = changes.geometries;
    if (everything) {
        wanted.resize(levels_.size());
        for (std::uint32_t i = 0; i < wanted.size(); ++i) wanted[i] = i;
    }
    for (const std::uint32_t index : wanted) {
        rebuilt[index] = true;
        if (auto taken = take_geometry(flat.geometries()[index], levels_[index]); !taken) {
            top_.reset();  // half an update is none: the next one starts afresh
            return tl::unexpected(taken.error());
        }
    }
    result.geometries_built = build_instanced_levels(flat);

    std::vector<bool> stale(instances_.size(), everything);
    for (const std::uint32_t index : changes.instances) stale[index] = true;
    std::vector<bool> material_changed(flat.materials().size(), false);
    for (const std::uint32_t index : changes.materials) material_changed[index] = true;
    bool top_changed = everything;
    for (std::uint32_t index = 0; index < instances_.size(); ++index) {
        const shading::InstanceData& data = flat.instances()[index];
        const bool level_rebuilt = data.geometry < rebuilt.size() && rebuilt[data.geometry];
        const Instance& instance = instances_[index];
        const bool mask_changed = instance.attached && data.material < material_changed.size() &&
                                  material_changed[data.material] && instance.mask != mask_of(flat, index);
        const bool now_instanced = instance.direct && levels_[data.geometry].scene;
        if (!stale[index] && !level_rebuilt && !mask_changed && !now_instanced) continue;
        if (!place_instance(flat, index)) continue;
        ++result.instances_updated;
        result.geometries_built += level_rebuilt && instance.direct ? 1 : 0;
        top_changed = true;
    }
    if (top_changed) {
        // One tree over all triangles traces fastest and is smallest. From the first change on, a tree a part and one over
        // these, opened where they overlap: what changed is built anew.
        if (!everything) rtcSetSceneFlags(top_.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
        rtcCommitScene(top_.get());
        result.top_level_built = true;
        any_translucent_ = std::any_of(instances_.begin(), instances_.end(), [](const Instance& instance) {
            return instance.attached && instance.mask == translucent_mask;
        });
    }
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE) {
        top_.reset();
        return fail("", fmt::format("Embree cannot build the scene (error {})", static_cast<int>(error)));
    }
    return result;
}

shading::KernelHit EmbreeScene::trace(const shading::KernelRay& ray) const {
    shading::KernelHit hit{};
    unsigned mask = opaque_mask | translucent_mask;
    if (ray.kind == shading::kernel_ray_shadow) {
        RTCRay segment = embree_ray(ray, opaque_mask);
        embree_occluded(top_.get(), segment);
        if (segment.tfar < 0) {
            hit.kind = shading::kernel_hit_blocked;
            return hit;
        }
        if (!any_translucent_) return hit;
        mask = translucent_mask;
    }
    RTCRayHit query{};
    query.ray = embree_ray(ray, mask);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(top_.get(), query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.kind = shading::kernel_hit_surface;
    hit.t = query.ray.tfar;
    const bool direct = query.hit.instID[0] == RTC_INVALID_GEOMETRY_ID;
    hit.instance = direct ? query.hit.geomID : query.hit.instID[0];
    hit.primitive = query.hit.primID;
    hit.barycentric = {query.hit.u, query.hit.v};
    hit.object_normal = {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z};
    return hit;
}

void EmbreeScene::trace(const KernelRays8& rays, KernelHits8& hits) const {
    static_assert(sizeof(RTCRay8::org_x) == sizeof rays.t_max);
    RTCRayHit8 query;
    RTCRay8& ray = query.ray;
    const auto copy = [](auto& to, const auto& from) { std::memcpy(&to, &from, sizeof from); };
    copy(ray.org_x, rays.origin[0]), copy(ray.org_y, rays.origin[1]), copy(ray.org_z, rays.origin[2]);
    copy(ray.dir_x, rays.direction[0]), copy(ray.dir_y, rays.direction[1]), copy(ray.dir_z, rays.direction[2]);
    copy(ray.tfar, rays.t_max);
    for (int i = 0; i < 8; ++i) {
        ray.tnear[i] = ray.time[i] = 0;
        ray.id[i] = ray.flags[i] = 0;
        query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    alignas(32) int open[8];
    copy(open, rays.valid);
    std::fill(std::begin(hits.kind), std::end(hits.kind), shading::kernel_hit_nothing);
    unsigned mask = opaque_mask | translucent_mask;
    if (rays.kind == shading::kernel_ray_shadow) {
        std::fill(std::begin(ray.mask), std::end(ray.mask), opaque_mask);
        embree_occluded(top_.get(), open, ray);
        bool any_open = false;
        for (int i = 0; i < 8; ++i) {
            const bool blocked = open[i] && ray.tfar[i] < 0;
            if (blocked) hits.kind[i] = shading::kernel_hit_blocked, open[i] = 0;
            any_open |= open[i] != 0;
        }
        if (!any_translucent_ || !any_open) return;
        mask = translucent_mask;
    }
    std::fill(std::begin(ray.mask), std::end(ray.mask), mask);
    embree_intersect(top_.get(), open, query);
    for (int i = 0; i < 8; ++i) {
        const bool met = open[i] && query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        if (met) hits.kind[i] = shading::kernel_hit_surface;
        const bool direct = query.hit.instID[0][i] == RTC_INVALID_GEOMETRY_ID;
        hits.instance[i] = direct ? query.hit.geomID[i] : query.hit.instID[0][i];
    }
    copy(hits.t, ray.tfar), copy(hits.primitive, query.hit.primID);
    copy(hits.barycentric[0], query.hit.u), copy(hits.barycentric[1], query.hit.v);
    copy(hits.object_normal[0], query.hit.Ng_x), copy(hits.object_normal[1], query.hit.Ng_y);
    copy(hits.object_normal[2], query.hit.Ng_z);
}

}  // namespace heliodon::trace
