#include "trace/embree_scene.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <utility>

#include "trace/embree_shapes.h"

namespace heliodon::trace {
namespace {

constexpr unsigned opaque_mask = 1;       // instances that block every ray
constexpr unsigned translucent_mask = 2;  // instances whose material may let a shadow ray through

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
    // Quadrilaterals are in refined trees only. Where a scene's quality asks for spatial splits Embree leaves out its
    // robust mode, in which rays miss no edge; where the device asks for them it keeps it.
    device_.reset(rtcNewDevice("quad_builder=sah_fast_spatial"));
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
        answer_exactly(level.geometry.get(), *level.shape);
    } else {
        const std::uint32_t highest = *std::max_element(mesh.indices.begin(), mesh.indices.end());
        if (highest >= mesh.positions.size())
            return fail(geometry->name,
                        fmt::format("expected vertex indices below {}, found {}", mesh.positions.size(), highest));
        take_mesh(mesh, level);
    }
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE)
        return fail(geometry->name, fmt::format("Embree cannot take it (error {})", static_cast<int>(error)));
    return {};
}

void EmbreeScene::take_mesh(const Mesh& mesh, Level& level) {
    const bool pairs = !level.pairs.members.empty();
    level.geometry.reset(rtcNewGeometry(device_.get(), pairs ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE));
    // Shared, never copied: Mesh's arrays are padded for Embree's 16-byte reads.
    rtcSetSharedGeometryBuffer(level.geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions.data(), 0, sizeof(glm::vec3), mesh.positions.size());
    if (pairs)
        rtcSetSharedGeometryBuffer(level.geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                   level.pairs.corners.data(), 0, sizeof(glm::uvec4), level.pairs.members.size());
    else
        rtcSetSharedGeometryBuffer(level.geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.indices.data(), 0, 3 * sizeof(std::uint32_t), mesh.triangle_count());
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
    instances_[index] = {.mask = mask_of(flat, index),
                         .attached = true,
                         .direct = !level.scene,
                         .pairs = level.pairs.members.empty() ? nullptr : level.pairs.members.data()};
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
    if (fine_ && concern_rays(flat, changes)) {
        fine_ = false;
        for (std::uint32_t index = 0; index < levels_.size(); ++index)
            if (!levels_[index].pairs.members.empty()) wanted.push_back(index);
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
        // One tree over all triangles traces fastest and is smallest. From the first change on, a tree a part and one
        // over these, opened where they overlap: what changed is built anew.
        if (!everything) rtcSetSceneFlags(top_.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
        commit(flat);
        result.top_level_built = true;
    }
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE) {
        top_.reset();
        return fail("", fmt::format("Embree cannot build the scene (error {})", static_cast<int>(error)));
    }
    return result;
}

void EmbreeScene::commit(const convert::FlatScene& flat) {
    rtcCommitScene(top_.get());
    translucent_.reset();
    const auto primitives = [&](std::uint32_t index) {
        const Geometry& geometry = *flat.geometries()[flat.instances()[index].geometry];
        return instances_[index].direct ? geometry.mesh.triangle_count() : std::size_t{1};
    };
    std::size_t all = 0, translucent = 0;
    for (std::uint32_t index = 0; index < instances_.size(); ++index) {
        if (!instances_[index].attached) continue;
        all += primitives(index);
        if (instances_[index].mask == translucent_mask) translucent += primitives(index);
    }
    if (translucent == 0) return;
    constexpr std::size_t share = 4;
    if (translucent > all / share) {  // a second tree would gain little and take too much memory
        rtcRetainScene(top_.get());
        translucent_.reset(top_.get());
        return;
    }
    translucent_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(translucent_.get(), RTC_SCENE_FLAG_ROBUST);
    for (std::uint32_t index = 0; index < instances_.size(); ++index)
        if (instances_[index].attached && instances_[index].mask == translucent_mask)
            rtcAttachGeometryByID(translucent_.get(), rtcGetGeometry(top_.get(), index), index);
    rtcCommitScene(translucent_.get());
}

bool EmbreeScene::concern_rays(const convert::FlatScene& flat, const convert::FlatChanges& changes) const {
    if (changes.everything || !changes.geometries.empty() || !changes.instances.empty()) return true;
    for (std::uint32_t index = 0; index < instances_.size(); ++index)
        if (instances_[index].attached && instances_[index].mask != mask_of(flat, index)) return true;
    return false;
}

Result<void> EmbreeScene::choose_tree(const convert::FlatScene& flat, std::size_t most_triangles) {
    constexpr std::size_t least_triangles = 4096;  // a smaller tree is in the cache, and no slower than a finer one
    std::vector<std::uint32_t> meshes;
    std::size_t triangles = 0;
    bool paired = false;
    for (std::uint32_t index = 0; index < instances_.size(); ++index) {
        if (!instances_[index].direct) continue;
        meshes.push_back(flat.instances()[index].geometry);
        triangles += flat.geometries()[meshes.back()]->mesh.triangle_count();
        paired = paired || instances_[index].pairs;
    }
    const auto rebuild_plain = [&]() -> Result<void> {
        for (const std::uint32_t mesh : meshes) levels_[mesh].pairs = {};
        if (rebuild_top(flat, meshes)) return {};
        top_.reset();
        return fail("", "Embree cannot build the scene anew");
    };
    const bool fine = triangles >= least_triangles && triangles <= std::min(most_triangles, TrianglePairs::most_triangles);
    if (fine == fine_) return {};
    fine_ = fine;
    if (!fine) return paired ? rebuild_plain() : Result<void>{};
    std::vector<TrianglePairs> pairs(meshes.size());
    tbb::parallel_for(std::size_t{0}, meshes.size(),
                      [&](std::size_t i) { pairs[i] = pair_triangles(flat.geometries()[meshes[i]]->mesh); });
    std::size_t quadrilaterals = 0;
    for (const TrianglePairs& each : pairs) quadrilaterals += each.members.size();
    if (quadrilaterals > triangles / 4 * 3) return {};  // so many alone would take more memory than triangles do
    for (std::size_t i = 0; i < meshes.size(); ++i) levels_[meshes[i]].pairs = std::move(pairs[i]);
    // Another Embree may not know the builder.
    return rebuild_top(flat, meshes) ? Result<void>{} : rebuild_plain();
}

bool EmbreeScene::rebuild_top(const convert::FlatScene& flat, const std::vector<std::uint32_t>& meshes) {
    translucent_.reset();
    top_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(top_.get(), RTC_SCENE_FLAG_ROBUST);
    for (const std::uint32_t mesh : meshes) take_mesh(flat.geometries()[mesh]->mesh, levels_[mesh]);
    for (std::uint32_t index = 0; index < instances_.size(); ++index) {
        instances_[index] = {};
        place_instance(flat, index);
    }
    commit(flat);
    return rtcGetDeviceError(device_.get()) == RTC_ERROR_NONE;
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
        if (!translucent_) return hit;
        mask = translucent_mask;
    }
    RTCRayHit query{};
    query.ray = embree_ray(ray, mask);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(mask == translucent_mask ? translucent_.get() : top_.get(), query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.kind = shading::kernel_hit_surface;
    hit.t = query.ray.tfar;
    const bool direct = query.hit.instID[0] == RTC_INVALID_GEOMETRY_ID;
    hit.instance = direct ? query.hit.geomID : query.hit.instID[0];
    hit.primitive = query.hit.primID;
    hit.barycentric = {query.hit.u, query.hit.v};
    if (const TrianglePairs::Members* pairs = instances_[hit.instance].pairs)
        unpair(pairs[hit.primitive], hit.primitive, hit.barycentric.x, hit.barycentric.y);
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
        if (!translucent_ || !any_open) return;
        mask = translucent_mask;
    }
    std::fill(std::begin(ray.mask), std::end(ray.mask), mask);
    embree_intersect(mask == translucent_mask ? translucent_.get() : top_.get(), open, query);
    for (int i = 0; i < 8; ++i) {
        const bool met = open[i] && query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        if (met) hits.kind[i] = shading::kernel_hit_surface;
        const bool direct = query.hit.instID[0][i] == RTC_INVALID_GEOMETRY_ID;
        hits.instance[i] = direct ? query.hit.geomID[i] : query.hit.instID[0][i];
    }
    copy(hits.t, ray.tfar), copy(hits.primitive, query.hit.primID);
    copy(hits.barycentric[0], query.hit.u), copy(hits.barycentric[1], query.hit.v);
    for (int i = 0; fine_ && i < 8; ++i) {
        if (hits.kind[i] != shading::kernel_hit_surface) continue;
        if (const TrianglePairs::Members* pairs = instances_[hits.instance[i]].pairs)
            unpair(pairs[hits.primitive[i]], hits.primitive[i], hits.barycentric[0][i], hits.barycentric[1][i]);
    }
    copy(hits.object_normal[0], query.hit.Ng_x), copy(hits.object_normal[1], query.hit.Ng_y);
    copy(hits.object_normal[2], query.hit.Ng_z);
}

}  // namespace heliodon::trace
