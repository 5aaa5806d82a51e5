#include "passes/cone_trace/cone_trace.h"

namespace heliodon::passes {

namespace {

/// Diffuse light of one pixel in four, and where it is.
struct HalfDiffuse {
    graph::ImageHandle light, places;
};

Result<HalfDiffuse> add_half_diffuse(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                     const LightingInputs& lighting, const VolumeInputs& volume, const VolumeImages& images,
                                     const Visibility& visibility, VkExtent2D extent) {
    auto pipeline = pipelines.compute("passes/cone_trace/half_diffuse.comp", {{6, volume.nested ? 1u : 0u}});
    if (!pipeline) return tl::unexpected(pipeline.error());
    const VkExtent3D half{(extent.width + 1) / 2, (extent.height + 1) / 2, 1};
    const HalfDiffuse result{
        graph.create_image({.name = "half diffuse", .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = half}),
        graph.create_image({.name = "half places", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .extent = half})};
    graph.add_pass(
        "cone trace diffuse", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(visibility.ids, graph::Usage::sampled);
            read_volume(pass, images);
            pass.write(result.light, graph::Usage::storage_write);
            pass.write(result.places, graph::Usage::storage_write);
        },
        [&scene, &lighting, &volume, images, visibility, result, half, trace = *pipeline](graph::PassContext& context) {
            const auto bindings = select_bindings(*trace, scene,
                                                  {{8, *lighting.frame},
                                                   {11, *lighting.shading_tables},
                                                   {12, gpu::Binding(context.image(visibility.ids), lighting.nearest)},
                                                   {13, context.image(result.light)},
                                                   {14, context.image(result.places)},
                                                   {20, gpu::Binding(context.image(images.faces), volume.trilinear)},
                                                   {21, *volume.data},
                                                   {22, gpu::Binding(context.image(images.depths), volume.trilinear)},
                                                   {23, *volume.cubes}});
            context.commands.dispatch_threads(*trace, gpu::NoPushConstants{}, bindings, {half.width, half.height, 1});
        });
    return result;
}

}  // namespace

Result<void> add_cone_trace(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                            const LightingInputs& lighting, const VolumeInputs& volume, const VolumeImages& images,
                            const Visibility& visibility, graph::ImageHandle picture, VkExtent2D extent,
                            const ConeTraceOptions& options) {
    auto pipeline = pipelines.compute("passes/cone_trace/cone_trace.comp",
                                      {{0, options.aov ? 1u : 0u}, {1, options.half_resolution ? 1u : 0u}, {6, volume.nested ? 1u : 0u}});
    if (!pipeline) return tl::unexpected(pipeline.error());
    HalfDiffuse diffuse{visibility.depth, visibility.depth};  // read by nothing, unless by the other half
    if (options.half_resolution) {
        auto added = add_half_diffuse(graph, pipelines, scene, lighting, volume, images, visibility, extent);
        if (!added) return tl::unexpected(added.error());
        diffuse = *added;
    }
    graph.add_pass(
        "cone trace", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(visibility.ids, graph::Usage::sampled);
            read_volume(pass, images);
            pass.read(diffuse.light, graph::Usage::sampled);
            if (options.half_resolution) pass.read(diffuse.places, graph::Usage::sampled);
            pass.read_write(picture, graph::Usage::storage_read_write);
        },
        [&scene, &lighting, &volume, images, visibility, picture, diffuse, extent, trace = *pipeline](graph::PassContext& context) {
            const gpu::Binding ids(context.image(visibility.ids), lighting.nearest);
            const auto bindings = select_bindings(*trace, scene,
                                                  {{8, *lighting.frame},
                                                   {11, *lighting.shading_tables},
                                                   {12, ids},
                                                   {13, context.image(picture)},
                                                   {14, gpu::Binding(context.image(diffuse.light), lighting.nearest)},
                                                   {15, gpu::Binding(context.image(diffuse.places), lighting.nearest)},
                                                   {20, gpu::Binding(context.image(images.faces), volume.trilinear)},
                                                   {21, *volume.data},
                                                   {22, gpu::Binding(context.image(images.depths), volume.trilinear)},
                                                   {23, *volume.cubes}});
            context.commands.dispatch_threads(*trace, gpu::NoPushConstants{}, bindings, {extent.width, extent.height, 1});
        });
    return {};
}

}  // namespace heliodon::passes
