#pragma once

#include <functional>
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
    bool anew = false;    ///< all surfaces each time, also those that never moved
    bool isotropic = false;  ///< a voxel shows one value to all sides
    bool lobes = true;       ///< what surfaces reflect specularly of lights goes ahead, not to all sides
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
    /// Brings the voxelized surfaces up to date: what never moved is voxelized once, and where a cascade moved, only the
    /// voxels that entered it. The texture shows those before until the next emission or bounce.
    /// `keep_light`: faces that were there before keep the light that they gathered. `beside`: Executor::execute().
    [[nodiscard]] Result<void> record_surfaces(gpu::Commands& commands, gpu::Timestamps* timestamps, bool keep_light,
                                               graph::Executor* beside = nullptr);
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
        float share = 1.0f;   ///< of diffuse_cone()
        std::optional<int> side;  ///< of the six, by its faces alone and those that have not gathered yet
    };
    [[nodiscard]] Result<void> record_bounce(gpu::Commands& commands, gpu::Timestamps* timestamps,
                                             const std::optional<Gather>& gather);
    /// record_lights() of a batch that is alone and record_bounce() side by side, where lights' cones are traced ahead.
    [[nodiscard]] Result<void> record_lit_bounce(gpu::Commands& commands, gpu::Timestamps* timestamps, std::uint32_t light_first,
                                                 std::uint32_t light_count, const Gather& gather);
    /// Cones and effects of this frame; before the frame's other work.
    [[nodiscard]] Result<void> upload_data(shading::VolumeData data);

    /// Whether surfaces found no room since the last call; if so, the next prepare() makes it. Waits.
    [[nodiscard]] Result<bool> grow();
    /// A measure of the light in the volume; waits.
    [[nodiscard]] Result<double> total_radiance() const;
    /// Whether any surface emits light.
    [[nodiscard]] bool emits() const { return emits_; }
    [[nodiscard]] const passes::VolumeInputs& inputs() const { return inputs_; }
    /// Goes up when the texture was made anew.
    [[nodiscard]] std::uint64_t texture_revision() const { return texture_revision_; }
    /// To be called when the shadow maps are other images than before, or lighting wants other pipelines.
    void forget_passes() { passes_known_ = false; }
    /// Goes up when cascades moved or were made anew: surfaces have to be voxelized again.
    [[nodiscard]] std::uint64_t placement_revision() const { return placement_revision_; }
    /// Edge of the finest voxels in metres.
    [[nodiscard]] float voxel_m() const { return data_.voxel_m; }

    /// The voxelized surfaces of a cascade: VoxelHeader and numbers, voxels, records.
    struct Surfaces {
        shading::VoxelGrid grid;
        const gpu::Buffer &numbers, &cells, &records;
    };
    [[nodiscard]] Surfaces surfaces(int cascade) const;
    /// How often a cascade's surfaces were voxelized so far, by what that took.
    struct Work {
        int all = 0;      ///< everything that does not move
        int entered = 0;  ///< voxels that entered a cascade
        int moving = 0;   ///< what moves
    };
    [[nodiscard]] const Work& work() const { return work_; }

private:
    struct Cascade {
        gpu::Buffer numbers, cells, records, tiles, levels, lit_faces, exitance, lobes, gathered;
        gpu::Buffer shown_numbers, shown_cells, shown_levels, shown_gathered;
        gpu::Buffer still_numbers, still_cells, still_records;  ///< surfaces that never moved: VoxelHeader, …
        shading::InjectConstants constants{};
        passes::VoxelizeInputs still, entered, moving;
        passes::GatherFaces gather_faces;  ///< the next gathering is for
        bool gathered_known = false;       ///< each face has gathered
        glm::ivec3 base{0};     ///< where the cascade lay when it was voxelized
        bool known = false;     ///< the surfaces that never moved are voxelized, at `base`:
        bool kept = false;      ///< they are in still_numbers, …
        bool in_place = false;  ///< they alone are in numbers, …
    };
    /// Steps in the life of one cascade's surfaces.
    struct SurfaceSteps {
        explicit SurfaceSteps(gpu::Device& device) : all(device), keep(device), enter(device), move(device), list(device) {}
        graph::Executor all, keep, enter, move, list;
    };
    struct Steps {
        explicit Steps(gpu::Device& device)
            : keep_shown(device), lights(device), emission(device), reflect(device), bounce(device), lit_bounce(device) {}
        graph::Executor keep_shown, lights, emission, reflect, bounce;
        graph::Executor lit_bounce;  // a bounce and, beside its gathering, the lights, where their cones are traced ahead
        std::vector<std::unique_ptr<SurfaceSteps>> surfaces;  // of each cascade
    };
    struct VolumeGraph;
    [[nodiscard]] Result<void> check_size(const VoxelSettings& settings) const;
    /// `lobes`: those of the volume, too.
    [[nodiscard]] Result<void> make_textures(VkExtent3D extent, bool lobes);
    [[nodiscard]] Result<void> make_buffers();
    [[nodiscard]] Result<void> make_still_buffers();
    void set_lights(std::uint32_t light_first, std::uint32_t light_count, bool add);
    [[nodiscard]] Result<void> set_gather(const Gather& gather);
    [[nodiscard]] Result<void> show(graph::Executor& step, gpu::Commands& commands, gpu::Timestamps* timestamps);
    [[nodiscard]] Result<void> place(const GpuScene& scene, glm::vec3 eye);
    [[nodiscard]] Result<void> list_triangles(const GpuScene& scene);
    [[nodiscard]] Result<void> record_surfaces(gpu::Commands& commands, gpu::Timestamps* timestamps, std::size_t cascade, graph::Executor* beside);
    void forget_surfaces();
    [[nodiscard]] Result<void> build_lit_bounce(const Source& source, const std::function<Result<void>(VolumeGraph&, bool)>& add_volume);
    [[nodiscard]] VolumeGraph begin_graph(const Source& source) const;
    [[nodiscard]] Result<void> finish_graph(graph::Executor& executor, VolumeGraph& volume, const Source& source) const;
    [[nodiscard]] Result<void> build_surface_graphs(const Source& source);
    [[nodiscard]] Result<void> build_graphs(const Source& source);

    gpu::Device& device_;
    gpu::Pipelines& pipelines_;
    std::unique_ptr<Steps> steps_;
    VoxelSettings settings_;
    shading::VolumeData data_{}, shown_{}, current_{};  // where cascades lie; as the texture shows it; as uploaded
    std::uint32_t record_capacity_ = 0, tile_capacity_ = 0;
    bool remake_ = true, emits_ = false, passes_known_ = false;
    bool outdated_ = false;  // the texture shows surfaces as they were before they were voxelized anew
    bool keeps_light_ = false, swapped_ = false;  // what those gathered goes over to the new ones
    std::uint64_t placement_revision_ = 0, texture_revision_ = 0, listed_revision_ = ~0ull, loaded_revision_ = ~0ull;
    Work work_;
    std::vector<std::unique_ptr<Cascade>> cascades_;
    std::vector<passes::TriangleRange> still_, moving_;
    GrowingBuffer still_ranges_{"triangle ranges", 0}, moving_ranges_{"moving triangle ranges", 0};
    float emission_unit_ = 1;
    gpu::Buffer data_buffer_, shown_buffer_;
    gpu::Image faces_, depths_, lobes_;
    gpu::Buffer occupancy_;
    passes::VolumeInputs inputs_, shown_inputs_;  // shown_inputs_: for light gathered while the texture is made anew
};

}  // namespace heliodon::realtime
