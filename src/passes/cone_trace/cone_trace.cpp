#include "passes/cone_trace/cone_trace.h"

namespace heliodon::passes {

Result<void> add_cone_trace(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                            const LightingInputs& lighting, const VolumeInputs& volume, graph::ImageHandle volume_faces,
                            const Visibility& visibility, graph::ImageHandle picture, VkExtent2D extent, bool aov) {
    auto pipeline = pipelines.compute("passes/cone_trace/cone_trace.comp", {{0, aov ? 1u : 0u}});
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "cone trace", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(visibility.ids, graph::Usage::sampled);
            pass.read(volume_faces, graph::Usage::sampled);
            pass.read_write(picture, graph::Usage::storage_read_write);
        },
        [&scene, &lighting, &volume, volume_faces, visibility, picture, extent, trace = *pipeline](graph::PassContext& context) {
            const auto bindings = select_bindings(*trace, scene,
                                                  {{8, *lighting.frame},
                                                   {11, *lighting.shading_tables},
                                                   {12, gpu::Binding(context.image(visibility.ids), lighting.nearest)},
                                                   {13, context.image(picture)},
                                                   {20, gpu::Binding(context.image(volume_faces), volume.trilinear)},
                                                   {21, *volume.data}});
            context.commands.dispatch_threads(*trace, gpu::NoPushConstants{}, bindings, {extent.width, extent.height, 1});
        });
    return {};
}

}  // namespace heliodon::passes
