#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gpu/timestamps.h"
#include "passes/inject/inject.h"
#include "realtime/gpu_scene.h"

namespace heliodon::realtime {

/// What the volume is made by.
struct VoxelSettings {
    int voxels = 128, cascades = 1;
    bool raster = false;  ///< the hardware rasterizer voxelizes
    bool operator==(const VoxelSettings&) const = default;
};

/// The scene as a filtered volume of radiance (docs/gi-theory.md). Its owner says when which step is due; each step
/// records its passes and waits for nothing.
class VoxelVolume {
public:
    VoxelVolume(gpu::Device& device, gpu::Pipelines& pipelines);

    /// A volume of nothing, so that inputs() always has one to bind.
    [[nodiscard]] Result<void> open();
    struct Source {
        const GpuScene& scene;
        const passes::SceneInputs& inputs;
        const passes::LightingInputs& lighting;
        const gpu::Image &shadow_depth, &shadow_slope;
    };
    /// Places the cascades about `eye`, makes what they need and lists the surfaces. Errors: a volume that the device cannot hold, with its size.
    [[nodiscard]] Result<void> prepare(const Source& source, const VoxelSettings& settings, glm::vec3 eye);
    /// Voxelizes all surfaces anew. The texture shows those before until the next emission or bounce.
    [[nodiscard]] Result<void> record_surfaces(gpu::Commands& commands, gpu::Timestamps* timestamps);
    /// Lights voxels with one batch of lights; `add`: to what those before gave.
    [[nodiscard]] Result<void> record_lights(gpu::Commands& commands, gpu::Timestamps* timestamps, std::uint32_t light_first,
                                             std::uint32_t light_count, bool add);
    /// The volume of what surfaces emit alone.
    [[nodiscard]] Result<void> record_emission(gpu::Commands& commands, gpu::Timestamps* timestamps);
    /// The volume of emission, the lights' light and what arrives from the volume as it was (unless nothing can:
    /// no Gather) and from the sky, reflected.
    struct Gather {
        glm::vec2 shift{0};   ///< of diffuse_cone()
        float weight = 1.0f;  ///< against what was gathered before
    };
    [[nodiscard]] Result<void> record_bounce(gpu::Commands& commands, gpu::Timestamps* timestamps,
                                             const std::optional<Gather>& gather);
    /// Cones and effects of this frame; before the frame's other work.
    [[nodiscard]] Result<void> upload_data(shading::VolumeData data);

    /// Whether surfaces found no room since the last call; if so, the next prepare() makes it. Waits.
    [[nodiscard]] Result<bool> grow();
    /// A measure of the light in the volume; waits.
    [[nodiscard]] Result<double> total_radiance();
    /// Whether any surface emits light.
    [[nodiscard]] bool emits() const { return emits_; }
    [[nodiscard]] const passes::VolumeInputs& inputs() const { return inputs_; }
    [[nodiscard]] const gpu::Image& faces() const { return faces_; }
    /// Goes up when the texture was made anew.
    [[nodiscard]] std::uint64_t texture_revision() const { return texture_revision_; }
    /// To be called when the shadow maps are other images than before, or lighting wants other pipelines.
    void forget_passes() { passes_known_ = false; }
    /// Goes up when cascades moved or were made anew: surfaces have to be voxelized again.
    [[nodiscard]] std::uint64_t placement_revision() const { return placement_revision_; }
    /// Edge of the finest voxels in metres.
    [[nodiscard]] float voxel_m() const { return data_.voxel_m; }

private:
    struct Cascade {
        gpu::Buffer numbers, cells, records, tiles, levels, illuminance, gathered;
        gpu::Buffer shown_numbers, shown_cells, shown_levels;
        shading::InjectConstants constants{};
        passes::VoxelizeInputs voxelize;
    };
    struct Steps {
        explicit Steps(gpu::Device& device) : surfaces(device), lights(device), emission(device), reflect(device), bounce(device) {}
        graph::Executor surfaces, lights, emission, reflect, bounce;
    };
    [[nodiscard]] Result<void> check_size(const VoxelSettings& settings) const;
    [[nodiscard]] Result<void> make_texture(VkExtent3D extent);
    [[nodiscard]] Result<void> make_buffers();
    [[nodiscard]] Result<void> show(graph::Executor& step, gpu::Commands& commands, gpu::Timestamps* timestamps);
    [[nodiscard]] Result<void> place(const GpuScene& scene, glm::vec3 eye);
    [[nodiscard]] Result<void> list_triangles(const GpuScene& scene);
    [[nodiscard]] Result<void> build_graphs(const Source& source);

    gpu::Device& device_;
    gpu::Pipelines& pipelines_;
    std::unique_ptr<Steps> steps_;
    VoxelSettings settings_;
    shading::VolumeData data_{};
    std::uint32_t record_capacity_ = 0, tile_capacity_ = 0;
    bool remake_ = true, emits_ = false, passes_known_ = false;
    bool outdated_ = false;  // the texture shows surfaces as they were before they were voxelized anew
    std::uint64_t placement_revision_ = 0, texture_revision_ = 0, listed_revision_ = ~0ull;
    std::vector<std::unique_ptr<Cascade>> cascades_;
    GrowingBuffer triangle_ranges_{"triangle ranges", 0};
    gpu::Buffer data_buffer_;
    gpu::Image faces_;
    passes::VolumeInputs inputs_;
};

}  // namespace heliodon::realtime
