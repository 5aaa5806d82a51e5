#include "passes/shade/shade.h"

namespace heliodon::passes {

Result<graph::ImageHandle> add_shade(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                     const LightingInputs& lighting, const Visibility& visibility,
                                     const ShadowMaps& shadow_maps, const VolumeImages& volume, VkExtent2D extent, bool aov) {
    gpu::Specialization constants = cone_constants(*lighting.volume, lighting.cone_shadows);
    constants[0] = aov ? 1 : 0;
    auto pipeline = pipelines.compute("passes/shade/shade.comp", constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    const graph::ImageHandle picture = graph.create_image(
        {.name = "radiance", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .extent = {extent.width, extent.height, 1}});
    graph.add_pass(
        "shade", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(visibility.ids, graph::Usage::sampled);
            pass.read(shadow_maps.depth, graph::Usage::sampled);
            pass.read(shadow_maps.slope, graph::Usage::sampled);
            read_volume(pass, volume);
            pass.write(picture, graph::Usage::storage_write);
        },
        [&scene, &lighting, visibility, shadow_maps, picture, extent, shade = *pipeline](graph::PassContext& context) {
            const auto bindings = select_bindings(*shade, scene,
                                                  {{8, *lighting.frame},
                                                   {9, *lighting.shadow_views},
                                                   {10, gpu::Binding(context.image(shadow_maps.depth), lighting.nearest)},
                                                   {15, gpu::Binding(context.image(shadow_maps.slope), lighting.nearest)},
                                                   {11, *lighting.shading_tables},
                                                   {24, *lighting.light_grid},
                                                   {16, *lighting.visible_lights},
                                                   {20, gpu::Binding(*lighting.volume->faces, lighting.volume->trilinear)},
                                                   {21, *lighting.volume->data},
                                                   {22, gpu::Binding(*lighting.volume->depths, lighting.volume->trilinear)},
                                                   {23, *lighting.volume->cubes},
                                                   {12, gpu::Binding(context.image(visibility.ids), lighting.nearest)},
                                                   {13, context.image(picture)}});
            context.commands.dispatch_threads(*shade, gpu::NoPushConstants{}, bindings, {extent.width, extent.height, 1});
        });
    return picture;
}

}  // namespace heliodon::passes
