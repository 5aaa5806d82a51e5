#pragma once

#include "passes/cull/cull.h"
#include "passes/shadow_volumes/shadow_volumes_shared.h"

namespace heliodon::passes {

/// The instances that cast shadows; the owner keeps this at one address.
struct Casters {
    const gpu::Buffer* ranges = nullptr;           ///< CasterRange
    const gpu::Buffer* first_triangles = nullptr;  ///< by instance
    const gpu::Buffer* edges = nullptr;            ///< CasterEdge
    const gpu::Buffer* edge_uses = nullptr;
    const gpu::Buffer* states = nullptr;           ///< a word a triangle: caster_…
    std::uint32_t range_count = 0, triangle_count = 0, edge_count = 0;
};

/// How every triangle stands to the sun; none is lit yet.
[[nodiscard]] Result<void> record_classify(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                           const Casters& casters, glm::vec3 sun, float significant_m2);

/// What is found in one part of the map.
struct LitMapBuffers {
    graph::BufferHandle states, header;  ///< Casters::states; LitMapHeader and the parts of the next round
};
/// Draws a part of the map, `part.size`² texels, and marks what it shows. `view` (ViewData) and `part` are read each
/// time.
[[nodiscard]] Result<void> add_lit_map(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene,
                                       const Casters& casters, const LitMapBuffers& buffers, const gpu::Buffer& view,
                                       const shading::LitMapConstants& part, std::uint32_t size,
                                       std::uint32_t instance_capacity);

/// Joins triangles to the lit ones where that leaves fewer silhouettes, and tallies these by instance (CasterTally, 0
/// before). `weights`: a word a triangle, 0 before and after.
[[nodiscard]] Result<void> record_joins(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                        const Casters& casters, const gpu::Buffer& weights, const gpu::Buffer& tallies);

/// What volumes are made of, from what is known of the triangles. `draws`: VolumeDraw, their counts 0; they count what
/// there is also where there is no room for it.
struct VolumeLists {
    const gpu::Buffer *sides = nullptr, *caps = nullptr, *draws = nullptr, *tallies = nullptr;
    std::uint32_t side_capacity = 0, cap_capacity = 0;
};
[[nodiscard]] Result<void> record_volume_lists(gpu::Commands& commands, gpu::Pipelines& pipelines,
                                               const SceneInputs& scene, const Casters& casters,
                                               const VolumeLists& lists, std::uint32_t choice);

}  // namespace heliodon::passes
