#include "passes/accumulate/accumulate.h"

#include "passes/accumulate/accumulate_shared.h"

namespace heliodon::passes {

Result<void> add_accumulate(graph::Graph& graph, gpu::Pipelines& pipelines, graph::ImageHandle picture,
                            graph::ImageHandle sum, const bool& replace, VkExtent2D extent) {
    auto pipeline = pipelines.compute("passes/accumulate/accumulate.comp");
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "accumulate", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(picture, graph::Usage::storage_read);
            pass.read_write(sum, graph::Usage::storage_read_write);
        },
        [picture, sum, extent, &replace, accumulate = *pipeline](graph::PassContext& context) {
            const shading::AccumulateConstants push{extent.width, extent.height, replace ? 1u : 0u};
            context.commands.dispatch_threads(*accumulate, push, {context.image(picture), context.image(sum)},
                                              {extent.width, extent.height, 1});
        });
    return {};
}

}  // namespace heliodon::passes
