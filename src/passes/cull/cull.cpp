#include "passes/cull/cull.h"

#include "passes/common/frame_shared.h"
#include "passes/cull/cull_shared.h"

namespace heliodon::passes {

using graph::PassBuilder;
using graph::PassContext;
using graph::PassKind;
using graph::Usage;
using shading::draw_lists_per_view;

static_assert(sizeof(shading::DrawCommand) == sizeof(VkDrawIndexedIndirectCommand));

VkDeviceSize DrawLists::commands_offset(std::uint32_t view, std::uint32_t list) const {
    return VkDeviceSize{view * draw_lists_per_view + list} * capacity * sizeof(VkDrawIndexedIndirectCommand);
}
VkDeviceSize DrawLists::count_offset(std::uint32_t view, std::uint32_t list) {
    return VkDeviceSize{view * draw_lists_per_view + list} * sizeof(std::uint32_t);
}

Result<DrawLists> add_cull(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                           const CullSettings& settings, const gpu::Buffer& views, const std::uint32_t& view_count) {
    auto pipeline = pipelines.compute("passes/cull/cull.comp");
    if (!pipeline) return tl::unexpected(pipeline.error());
    DrawLists lists;
    lists.capacity = settings.capacity;
    const VkDeviceSize list_count = VkDeviceSize{settings.max_views} * draw_lists_per_view;
    lists.commands = graph.create_buffer(
        {"draw commands", list_count * settings.capacity * sizeof(VkDrawIndexedIndirectCommand)});
    lists.counts = graph.create_buffer({"draw counts", list_count * sizeof(std::uint32_t)});

    graph.add_pass(
        "cull clear", PassKind::transfer, [&](PassBuilder& pass) { pass.write(lists.counts, Usage::transfer_write); },
        [lists](PassContext& context) { context.commands.fill(context.buffer(lists.counts), 0); });
    graph.add_pass(
        "cull", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read_write(lists.counts, Usage::storage_read_write);
            pass.write(lists.commands, Usage::storage_write);
        },
        [lists, settings, &scene, &views, &view_count, cull = *pipeline](PassContext& context) {
            if (scene.instance_count == 0 || view_count == 0) return;
            const shading::CullConstants push{scene.instance_count, lists.capacity, settings.merge_blended ? 1u : 0u, 0};
            const auto bindings = select_bindings(
                *cull, scene, {{8, views}, {9, context.buffer(lists.commands)}, {10, context.buffer(lists.counts)}});
            context.commands.dispatch_threads(*cull, push, bindings, {scene.instance_count, view_count, 1});
        });
    return lists;
}

void draw_list(graph::PassContext& context, SceneInputs& scene, const DrawLists& lists, std::uint32_t view,
               std::uint32_t list) {
    if (scene.instance_count == 0) return;
    ++scene.draw_calls;
    context.commands.bind_index_buffer(*scene.index_buffer);
    context.commands.draw_indexed_indirect_count(context.buffer(lists.commands), lists.commands_offset(view, list),
                                                 context.buffer(lists.counts), DrawLists::count_offset(view, list),
                                                 scene.instance_count);
}

}  // namespace heliodon::passes
