#include "passes/ambient_occlusion/ambient_occlusion.h"

namespace heliodon::passes {

using graph::Usage;

Result<void> add_ambient_occlusion(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                   const LightingInputs& lighting, const Surfaces& surfaces, graph::ImageHandle picture,
                                   VkExtent2D extent, const shading::AmbientOcclusionConstants& constants, bool aov) {
    gpu::Specialization specialization{{0, aov ? 1u : 0u}};
    set_material_constants(specialization, scene);
    auto pipeline = pipelines.compute("passes/ambient_occlusion/ambient_occlusion.comp", specialization);
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "ambient occlusion", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            for (const graph::ImageHandle image : {surfaces.places, surfaces.albedos, surfaces.lobes}) pass.read(image, Usage::sampled);
            pass.read_write(picture, Usage::storage_read_write);
        },
        [&scene, &lighting, &constants, surfaces, picture, extent, occlude = *pipeline](graph::PassContext& context) {
            const auto sampled = [&](graph::ImageHandle image) { return gpu::Binding(context.image(image), lighting.nearest); };
            const auto bindings = select_bindings(*occlude, scene,
                                                  {{8, *lighting.frame},
                                                   {11, *lighting.shading_tables},
                                                   {12, sampled(surfaces.places)},
                                                   {13, context.image(picture)},
                                                   {18, sampled(surfaces.albedos)},
                                                   {19, sampled(surfaces.lobes)}});
            context.commands.dispatch_threads(*occlude, constants, bindings, {extent.width, extent.height, 1});
        });
    return {};
}

}  // namespace heliodon::passes
