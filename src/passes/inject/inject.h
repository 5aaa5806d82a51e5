#pragma once

#include "passes/cone_trace/cone_trace.h"
#include "passes/inject/inject_shared.h"
#include "passes/shade/shade.h"
#include "passes/voxelize/voxelize.h"

namespace heliodon::passes {

/// Which voxels of a cascade the texture shows, kept while its surfaces are voxelized anew.
struct ShownVoxels {
    graph::BufferHandle numbers;  ///< VoxelHeader
    graph::BufferHandle cells, levels;
    graph::BufferHandle gathered;  ///< InjectCascade::gathered of those voxels
};

/// Which of the six faces gather next, a bit each.
struct GatherFaces {
    std::uint32_t all = 0;    ///< of all voxels
    std::uint32_t unlit = 0;  ///< where they have not gathered yet
};

/// One cascade as injection works on it.
struct InjectCascade {
    const shading::InjectConstants* constants = nullptr;  ///< the owner keeps them at one address and up to date
    /// The texture still shows surfaces that have been voxelized anew since.
    const bool* outdated = nullptr;
    /// The light that faces gathered goes with them from the voxels that are shown to those that surfaces fill now.
    const bool* keeps_light = nullptr;
    /// Cells, levels and gathered light have changed places with those that are shown, instead of being copied.
    const bool* swapped = nullptr;
    ShownVoxels shown;
    VoxelSurfaces surfaces;
    graph::BufferHandle lit_faces;    ///< LitFacesHeader and the lists
    const GatherFaces* gather_faces = nullptr;  ///< the next gathering is for
    graph::BufferHandle exitance;     ///< what faces reflect of the lights evenly, in lux: 16 bytes a record's face
    graph::BufferHandle lobes;        ///< and ahead (face_lobe.glsl), likewise; if any
    graph::BufferHandle gathered;     ///< illuminance from the volume and the sky, likewise; w: 1 once a face has gathered
    bool isotropic = false;           ///< a voxel shows one value to all sides
};

/// Lists the faces that light can leave, once a cascade's surfaces are voxelized: of lit_faces_bytes().
[[nodiscard]] Result<void> add_list_faces(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade);
[[nodiscard]] VkDeviceSize lit_faces_bytes(std::uint32_t record_capacity);
/// Keeps the lists of the voxels that the texture shows, and what they gathered, unless they are kept already.
void add_keep_shown(graph::Graph& graph, const InjectCascade& cascade);
/// If the texture is outdated, empties what it shows of a cascade; `levels`: its coarse levels too.
[[nodiscard]] Result<void> add_volume_clear(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade,
                                            const VolumeImages& images, bool levels);
/// What faces reflect of one batch of lights (light_first and light_count of the constants) by the resident shadow maps,
/// or by cones through the volume as it is, which `shares` holds already where they were traced beside the gathering.
[[nodiscard]] Result<void> add_direct_light(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                            const LightingInputs& lighting, const InjectCascade& cascade,
                                            const ShadowMaps& shadow_maps, const VolumeImages& images,
                                            graph::BufferHandle shares = {});
struct VoxelShadows;  // passes/shadow_cones
/// Replaces `gathered` of the faces asked for by what arrives from the volume and the sky. `beside`, if any, is traced at once.
[[nodiscard]] Result<void> add_gather(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                      const VolumeInputs& volume, const InjectCascade& cascade, const VolumeImages& images,
                                      const VoxelShadows* beside = nullptr);
/// Writes level 0: emission, and unless `emission_only` what both illuminances reflect.
[[nodiscard]] Result<void> add_radiance(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade,
                                        const VolumeImages& images, bool emission_only);
/// Writes level 1 of what faces send ahead, if a cascade has lobes: unless `emission_only`, of the lights.
[[nodiscard]] Result<void> add_lobes(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade,
                                     const VolumeImages& images, bool emission_only);
/// Work on level 0 of the texture, to go beside the filtering of level 1.
struct FinestWork {
    std::function<void(graph::PassBuilder&)> uses;
    std::function<void(graph::PassContext&)> record;
};
/// Writes the coarse levels of a cascade from its level 0, and of its lobes from level 1.
[[nodiscard]] Result<void> add_filter(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade,
                                      const VolumeImages& images, const FinestWork& beside);

}  // namespace heliodon::passes
