#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "convert/flat_scene.h"
#include "core/result.h"
#include "gpu/commands.h"
#include "gpu/device.h"
#include "passes/common/ambient_shared.h"
#include "passes/common/frame_shared.h"
#include "passes/common/scene_inputs.h"
#include "realtime/moving_instances.h"
#include "realtime/range_allocator.h"
#include "realtime/renderer.h"
#include "scene/scene.h"

namespace heliodon::realtime {

/// Instances that there is room for where there are so many.
[[nodiscard]] constexpr std::uint32_t instance_capacity(std::uint32_t instances) {
    return std::bit_ceil(std::max(instances, 16u));
}

/// A storage buffer that grows, keeping its contents.
class GrowingBuffer {
public:
    GrowingBuffer(std::string name, VkBufferUsageFlags usage) : name_(std::move(name)), usage_(usage) {}
    /// Room for `bytes`; `used` bytes from the start survive a reallocation.
    [[nodiscard]] Result<void> reserve(gpu::Device& device, std::uint64_t bytes, std::uint64_t used);
    [[nodiscard]] const gpu::Buffer& buffer() const { return buffer_; }
    [[nodiscard]] std::uint64_t size() const { return buffer_.size(); }

private:
    std::string name_;
    VkBufferUsageFlags usage_;
    gpu::Buffer buffer_;
};

/// The GPU's copy of a scene: mega vertex and index buffers, tables, bindless textures. It follows the
/// scene's journal; only what changed is uploaded.
class GpuScene {
public:
    explicit GpuScene(gpu::Device& device);
    ~GpuScene();
    GpuScene(const GpuScene&) = delete;
    GpuScene& operator=(const GpuScene&) = delete;

    [[nodiscard]] Result<RealtimeUpdate> update(const Scene& scene);
    /// Bindings 0 to 7 of passes/common/scene_tables.glsl.
    void append_bindings(std::vector<gpu::Binding>& bindings) const;
    /// Writes where a light's shadow views begin (LightData::shadow), and the list of lights that shine.
    [[nodiscard]] Result<void> set_light_shadows(const std::vector<std::uint32_t>& shadow_of_light,
                                                 const std::vector<std::uint32_t>& active_lights);
    /// Shades with `light` in the place of light `index` until the scene's own is uploaded again.
    [[nodiscard]] Result<void> stand_in_for_light(std::uint32_t index, const shading::LightData& light);
    /// Bindless slots of the environment's maps, for shading.
    struct SkyMaps {
        std::uint32_t specular = shading::no_texture, irradiance = shading::no_texture;
        std::uint32_t picture = shading::no_texture;  ///< of a sky that is a formula
        std::uint32_t specular_levels = 1;
    };
    [[nodiscard]] Result<void> set_sky_maps(const SkyMaps& maps);
    /// What stands for the light of surroundings where none is traced.
    struct Ambient {
        shading::AmbientData data{.sky_slot = shading::no_texture};
        std::vector<shading::AmbientLightData> lights;
    };
    [[nodiscard]] Result<void> set_ambient(Ambient ambient);

    [[nodiscard]] const convert::FlatScene& flat() const { return flat_; }
    [[nodiscard]] const gpu::Buffer& index_buffer() const { return indices_.buffer(); }
    /// shading/luminaire.h's table.
    [[nodiscard]] const gpu::Buffer& luminaire_buffer() const { return luminaires_.buffer(); }
    [[nodiscard]] std::uint32_t instance_count() const { return static_cast<std::uint32_t>(flat_.instances().size()); }
    /// Whether any visible instance needs the alpha-tested or the blended draw list.
    [[nodiscard]] bool has_tested() const { return has_tested_; }
    [[nodiscard]] bool has_blended() const { return has_blended_; }
    /// Of the materials of what is visible, the lights as the scene has them, and the sky.
    [[nodiscard]] const passes::SceneFeatures& features() const { return features_; }
    /// Bytes that the vertices' attributes take on the device.
    [[nodiscard]] std::uint64_t vertex_bytes() const { return vertex_ranges_.used() * 4; }
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    /// Goes up whenever an update changed anything; accumulated pictures older than it are stale.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    /// Goes up when the sky or its picture changed.
    [[nodiscard]] std::uint64_t sky_revision() const { return sky_revision_; }
    [[nodiscard]] std::uint64_t light_revision() const { return light_revision_; }
    /// Goes up when anything changed that voxelization reads: instances, geometry, materials and their textures.
    [[nodiscard]] std::uint64_t surface_revision() const { return surfaces_.revision(); }
    /// Which instances changed, and when.
    [[nodiscard]] const MovingInstances& surfaces() const { return surfaces_; }
    /// By geometry: goes up when its mesh was uploaded anew.
    [[nodiscard]] const std::vector<std::uint64_t>& geometry_revisions() const { return geometry_revisions_; }
    /// Of a sky that is an image; else null.
    [[nodiscard]] const gpu::Image* sky_image() const;

private:
    struct Range {
        std::uint64_t start = 0, size = 0;
    };
    struct Allocation {
        Range attributes, indices;  // 32-bit words, indices
    };
    struct LoadedTexture {
        gpu::Image image;
        std::uint32_t slot = shading::no_texture;
    };

    [[nodiscard]] Result<void> upload_geometries(const std::vector<std::uint32_t>& changed, RealtimeUpdate& update);
    [[nodiscard]] Result<void> upload_geometry(std::uint32_t index, RealtimeUpdate& update);
    [[nodiscard]] Result<void> reserve_for(const std::vector<std::uint32_t>& changed);
    [[nodiscard]] Result<void> grow_ranges(GrowingBuffer& buffer, RangeAllocator& ranges, std::uint64_t count);
    [[nodiscard]] Result<std::uint64_t> allocate(GrowingBuffer& buffer, RangeAllocator& ranges, std::uint64_t size);
    void release_geometry(std::uint32_t index);
    [[nodiscard]] Result<bool> upload_textures(const std::vector<std::uint32_t>& changed, RealtimeUpdate& update);
    [[nodiscard]] Result<void> upload_texture(std::uint32_t index, RealtimeUpdate& update);
    [[nodiscard]] Result<void> upload_materials(const std::vector<std::uint32_t>& changed, RealtimeUpdate& update);
    [[nodiscard]] Result<void> upload_sky();
    [[nodiscard]] std::uint32_t slot_of(std::uint32_t texture) const;
    void classify();

    gpu::Device& device_;
    convert::FlatScene flat_;
    GrowingBuffer vertices_, indices_, geometries_, instances_, materials_, lights_, active_lights_, sky_, luminaires_;
    RangeAllocator vertex_ranges_, index_ranges_;
    std::vector<Allocation> allocations_;
    std::vector<shading::GeometryData> geometry_table_;
    std::vector<std::uint64_t> geometry_revisions_;
    std::vector<std::optional<LoadedTexture>> textures_;
    std::vector<std::uint32_t> light_shadows_;
    SkyMaps sky_maps_;
    Ambient ambient_;
    MovingInstances surfaces_;
    Bounds bounds_;
    bool compact_ = false;  // convert.vertex_precision
    bool has_tested_ = false, has_blended_ = false;
    passes::SceneFeatures features_;
    std::uint64_t revision_ = 0, sky_revision_ = 0, light_revision_ = 0;
};

}  // namespace heliodon::realtime
