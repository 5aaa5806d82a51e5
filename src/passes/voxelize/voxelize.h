#pragma once

#include "graph/executor.h"
#include "passes/common/scene_inputs.h"
#include "passes/voxelize/voxel_shared.h"

namespace heliodon::passes {

/// The triangles to voxelize: one range a visible instance, ascending. A thread finds its instance by bisection.
struct TriangleRange {
    std::uint32_t first_triangle = 0;  ///< triangles of the ranges before
    std::uint32_t instance = 0;
};

/// What voxelization reads besides the scene's tables; the owner keeps it at one address and up to date.
struct VoxelizeInputs {
    shading::VoxelGrid grid{};
    const gpu::Buffer* triangle_ranges = nullptr;  ///< TriangleRange
    std::uint32_t range_count = 0, triangle_count = 0;
    const gpu::Buffer* shading_tables = nullptr;
    glm::ivec3 shift{0};        ///< voxel v of the grid was voxel v + shift of the grid that VoxelSurfaces::carried fill
    bool entered_only = false;  ///< triangles count in voxels alone that the other grid did not have
};

/// Surfaces that were voxelized before: of a grid as large, with as many records.
struct CarriedSurfaces {
    graph::BufferHandle numbers;  ///< VoxelHeader
    graph::BufferHandle cells, records;
};

/// One cascade's surfaces. Sizes follow from voxel_buffer_sizes().
struct VoxelSurfaces {
    graph::BufferHandle numbers;  ///< VoxelHeader, then 4 bytes a voxel
    graph::BufferHandle cells;    ///< 4 bytes a record: its voxel, x + n (y + n z)
    graph::BufferHandle records;  ///< voxel_faces × voxel_field_count words a record
    graph::BufferHandle tiles;    ///< VoxelTile
    graph::BufferHandle levels;   ///< VoxelLevelsHeader and the lists
    std::uint32_t size = 0;       ///< voxels an edge
    std::uint32_t record_capacity = 0, tile_capacity = 0;
    CarriedSurfaces carried{};  ///< if any: triangles are added to them
};
struct VoxelBufferSizes {
    VkDeviceSize numbers = 0, cells = 0, records = 0, tiles = 0, levels = 0;
};
[[nodiscard]] VoxelBufferSizes voxel_buffer_sizes(std::uint32_t size, std::uint32_t record_capacity, std::uint32_t tile_capacity);

/// Voxelizes every triangle by compute. Every voxel that a triangle passes through is found (a closed surface stays
/// closed) and the exact part of the triangle in it counts; sums depend neither on the order of threads nor on which
/// triangles were voxelized before and carried.
/// Where a count of the header exceeds its capacity, what found no room is missing, and the demand says how much
/// is needed.
[[nodiscard]] Result<void> add_voxelize(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                        const VoxelizeInputs& inputs, const VoxelSurfaces& surfaces);

/// The same by the hardware's rasterizer: each triangle projected along its dominant axis, conservatively; `tiles` is
/// not used. Error where the device has no geometry shaders (DeviceInfo::geometry_shader). The records hold the same.
[[nodiscard]] Result<void> add_voxelize_raster(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                               const VoxelizeInputs& inputs, const VoxelSurfaces& surfaces);

}  // namespace heliodon::passes
