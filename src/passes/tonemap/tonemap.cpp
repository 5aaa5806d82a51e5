#include "passes/tonemap/tonemap.h"

#include "passes/tonemap/tonemap_shared.h"

namespace heliodon::passes {

Result<void> add_tonemap(graph::Graph& graph, gpu::Pipelines& pipelines, graph::ImageHandle sum,
                         graph::ImageHandle display, const float& scale, VkExtent2D extent) {
    auto pipeline = pipelines.compute("passes/tonemap/tonemap.comp");
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "tonemap", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(sum, graph::Usage::storage_read);
            pass.write(display, graph::Usage::storage_write);
        },
        [sum, display, extent, &scale, tonemap = *pipeline](graph::PassContext& context) {
            const shading::TonemapConstants push{extent.width, extent.height, scale};
            context.commands.dispatch_threads(*tonemap, push, {context.image(sum), context.image(display)},
                                              {extent.width, extent.height, 1});
        });
    return {};
}

}  // namespace heliodon::passes
