#pragma once

#include "graph/executor.h"
#include "passes/common/scene_inputs.h"

namespace heliodon::passes {

/// What raster passes draw: for each view, one list of VkDrawIndexedIndirectCommand an opacity class
/// (draw_list_… of frame_shared.h), each with room for `capacity`, and its count.
struct DrawLists {
    graph::BufferHandle commands, counts;
    std::uint32_t capacity = 0;
    [[nodiscard]] VkDeviceSize commands_offset(std::uint32_t view, std::uint32_t list) const;
    [[nodiscard]] static VkDeviceSize count_offset(std::uint32_t view, std::uint32_t list);
};

struct CullSettings {
    std::uint32_t max_views = 1;
    std::uint32_t capacity = 0;   ///< instances at most
    bool merge_blended = false;   ///< shadow views: blended surfaces join the tested list
};
/// Frustum culling of every instance against every view, on the GPU. `views` (ViewData) and the number of
/// them are read each frame.
[[nodiscard]] Result<DrawLists> add_cull(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                         const CullSettings& settings, const gpu::Buffer& views,
                                         const std::uint32_t& view_count);

/// Draws one list of one view inside begin_rendering, with one indirect call.
void draw_list(graph::PassContext& context, SceneInputs& scene, const DrawLists& lists, std::uint32_t view,
               std::uint32_t list);

}  // namespace heliodon::passes
