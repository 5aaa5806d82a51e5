#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "convert/flat_scene.h"
#include "core/result.h"
#include "shading/kernel_state.h"
#include "trace/embree_api.h"
#include "trace/path_tracer.h"
#include "trace/triangle_pairs.h"

namespace heliodon::trace {

/// Owns one reference to an Embree object.
template <class Object, void (*release)(Object)>
struct EmbreeRelease {
    using pointer = Object;
    void operator()(Object object) const { release(object); }
};
using DeviceReference = std::unique_ptr<std::remove_pointer_t<RTCDevice>, EmbreeRelease<RTCDevice, rtcReleaseDevice>>;
using SceneReference = std::unique_ptr<std::remove_pointer_t<RTCScene>, EmbreeRelease<RTCScene, rtcReleaseScene>>;
using GeometryReference =
    std::unique_ptr<std::remove_pointer_t<RTCGeometry>, EmbreeRelease<RTCGeometry, rtcReleaseGeometry>>;

/// Eight rays of one kind, number by number, of which those count that are −1 in `valid`; and what they met.
struct alignas(32) KernelRays8 {
    int valid[8];
    float origin[3][8], direction[3][8], t_max[8];
    std::uint32_t kind;
};
struct alignas(32) KernelHits8 {
    float object_normal[3][8], t[8], barycentric[2][8];
    std::uint32_t instance[8], primitive[8], kind[8];
};

/// Answers the kernel's rays on the CPU, over the scene's own vertex arrays: a top level of instances numbered as
/// FlatScene numbers them. A mesh that one instance uses as it was modelled stands in the top level itself, whose tree
/// then need not be left for another; every other geometry has an Embree scene of its own, shapes among them, which
/// their boxes enclose as tightly as a tree would.
class EmbreeScene {
public:
    /// Follows `changes`. The vertex arrays of `flat` must stay in place until the next update. After an
    /// error the next update starts afresh.
    [[nodiscard]] Result<TraceUpdate> update(const convert::FlatScene& flat, const convert::FlatChanges& changes);

    /// The tree for what is traced next, which depends on the scene and `most_triangles` alone, not on what was traced
    /// before. Of no more triangles than that, and where it can gain anything, over pairs of triangles and with spatial
    /// splits, which takes a few times as long to build; else as update() builds it. A tree that fits already stays.
    [[nodiscard]] Result<void> choose_tree(const convert::FlatScene& flat, std::size_t most_triangles);

    /// The nearest hit of a scatter ray. Of a shadow ray: blocked, or the nearest surface that might let
    /// light through, or nothing.
    [[nodiscard]] shading::KernelHit trace(const shading::KernelRay& ray) const;
    /// The same of eight.
    void trace(const KernelRays8& rays, KernelHits8& hits) const;

private:
    struct Level {
        std::unique_ptr<Shape> shape;  ///< what the user-geometry callbacks read
        TrianglePairs pairs;           ///< of what stands in a refined tree
        GeometryReference geometry;
        SceneReference scene;  ///< what instances show; none while the geometry stands in the top level
    };
    struct Instance {
        unsigned mask = 0;
        bool attached = false;
        bool direct = false;                            ///< its geometry itself is attached
        const TrianglePairs::Members* pairs = nullptr;  ///< of its geometry, if that is refined
    };

    Result<void> open_device();
    Result<void> take_geometry(const Geometry* geometry, Level& level);
    void take_mesh(const Mesh& mesh, Level& level);
    void build_level(Level& level);
    /// Gives shapes, and meshes that have moved or are used again, scenes of their own, which they keep; how many.
    int build_instanced_levels(const convert::FlatScene& flat);
    /// False where nothing changed: a hole stays a hole.
    bool place_instance(const convert::FlatScene& flat, std::uint32_t index);
    /// Whether rays would meet anything else after `changes`, or meet it as something else.
    [[nodiscard]] bool concern_rays(const convert::FlatScene& flat, const convert::FlatChanges& changes) const;
    /// All instances in a new tree, with those `meshes` taken anew; false if Embree cannot.
    bool rebuild_top(const convert::FlatScene& flat, const std::vector<std::uint32_t>& meshes);
    /// Builds the top level and the tree of what is translucent.
    void commit(const convert::FlatScene& flat);

    // In this order: the device goes last.
    DeviceReference device_;
    std::vector<Level> levels_;
    std::vector<Instance> instances_;
    SceneReference top_;
    SceneReference
        translucent_;    ///< what shadow rays may pass, again: a tree of its own if it is little; none without any
    bool fine_ = false;  ///< refined
};

}  // namespace heliodon::trace
