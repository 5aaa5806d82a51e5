#pragma once

#include "passes/compute_raster/compute_raster_shared.h"
#include "passes/shadow/shadow.h"
#include "passes/visibility/visibility.h"
#include "passes/voxelize/voxelize.h"

namespace heliodon::passes {

/// Views drawn together: their keys lie in one buffer.
struct RasterBatch {
    std::uint32_t view_first = 0, view_count = 0;
    std::uint32_t key_count = 0, tile_count = 0;
};

/// What rasterization by compute draws besides the scene's tables; the owner keeps it at one address and up to date.
struct ComputeRasterInputs {
    const gpu::Buffer* triangle_ranges = nullptr;  ///< TriangleRange
    std::uint32_t range_count = 0, triangle_count = 0;
    const gpu::Buffer* views = nullptr;  ///< RasterView
    std::vector<RasterBatch> batches;
    std::uint32_t random_seed = 0;  ///< of the share of light that blended surfaces let through
    bool tests_opacity = false;  ///< something is alpha-masked or blended; read when passes are added, as are the next
    /// Room for large triangles and their strips; where more is wanted, drawing is slower.
    std::uint32_t large_capacity = 1 << 18, strip_capacity = 1 << 20;
};

/// Depth maps that compute may write; looked up as those of shadow_depth_format.
inline constexpr VkFormat computed_depth_format = VK_FORMAT_R32_SFLOAT;

/// Whether the device has 64-bit atomics on buffers, and binds the keys of a view of so many pixels.
[[nodiscard]] bool can_raster_by_compute(const gpu::Device& device, std::uint64_t pixels_a_view);
/// Keys of views drawn together at most: of all their pixels, or as many as the device binds.
[[nodiscard]] std::uint64_t raster_key_capacity(const gpu::Device& device, std::uint64_t pixels);
/// A view of `size` pixels at `corner` of the picture or of a layer.
[[nodiscard]] shading::RasterView raster_view(const glm::mat4& world_to_clip, glm::uvec2 corner, glm::uvec2 size,
                                              std::uint32_t layer, std::uint32_t number);
/// Which views are drawn together, in their order; sets their keys' places.
[[nodiscard]] std::vector<RasterBatch> raster_batches(std::span<shading::RasterView> views, std::uint64_t key_capacity);

/// add_visibility() by compute (a pixel's nearest triangle by a 64-bit atomic maximum of depth and triangle). Depth
/// is no attachment but of computed_depth_format, and blended surfaces are not left out: the scene must have none.
[[nodiscard]] Result<Visibility> add_visibility_by_compute(graph::Graph& graph, gpu::Pipelines& pipelines,
                                                           const SceneInputs& scene, const ComputeRasterInputs& inputs,
                                                           VkExtent2D extent);

/// add_shadow() by compute, to maps of computed_depth_format. `key_capacity`: as given to raster_batches().
[[nodiscard]] Result<void> add_shadow_by_compute(graph::Graph& graph, gpu::Pipelines& pipelines,
                                                 const SceneInputs& scene, const ComputeRasterInputs& inputs,
                                                 const ShadowMaps& maps, std::uint64_t key_capacity);

}  // namespace heliodon::passes
