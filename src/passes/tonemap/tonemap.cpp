#include "passes/tonemap/tonemap.h"

namespace heliodon::passes {

Result<void> add_tonemap(graph::Graph& graph, gpu::Pipelines& pipelines, graph::ImageHandle sum, graph::BufferHandle exposure,
                         graph::ImageHandle display, const shading::TonemapConstants& constants, VkExtent2D extent) {
    auto pipeline = pipelines.compute("passes/tonemap/tonemap.comp");
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "tonemap", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(sum, graph::Usage::storage_read);
            pass.read(exposure, graph::Usage::storage_read);
            pass.write(display, graph::Usage::storage_write);
        },
        [sum, exposure, display, extent, &constants, tonemap = *pipeline](graph::PassContext& context) {
            shading::TonemapConstants push = constants;
            push.width = extent.width;
            push.height = extent.height;
            context.commands.dispatch_threads(*tonemap, push,
                                              {context.image(sum), context.image(display), context.buffer(exposure)},
                                              {extent.width, extent.height, 1});
        });
    return {};
}

}  // namespace heliodon::passes
