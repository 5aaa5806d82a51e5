#include "passes/shade/shade.h"

namespace heliodon::passes {
namespace {

graph::ImageHandle image(graph::Graph& graph, const char* name, VkFormat format, VkExtent2D size) {
    return graph.create_image({.name = name, .format = format, .extent = {size.width, size.height, 1}});
}

}  // namespace

Surfaces create_surfaces(graph::Graph& graph, const Visibility& visibility, VkExtent2D extent) {
    return {.places = image(graph, "surface places", VK_FORMAT_R32G32B32A32_UINT, extent),
            .albedos = image(graph, "surface albedos", VK_FORMAT_R32G32B32A32_UINT, extent),
            .lobes = image(graph, "surface lobes", VK_FORMAT_R32_UINT, extent),
            .ids = visibility.ids};
}

Result<void> add_surfaces(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                          const LightingInputs& lighting, const Surfaces& surfaces, VkExtent2D extent) {
    gpu::Specialization constants;
    set_material_constants(constants, scene);
    auto pipeline = pipelines.compute("passes/shade/surfaces.comp", constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "surfaces", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(surfaces.ids, graph::Usage::sampled);
            for (const graph::ImageHandle written : {surfaces.places, surfaces.albedos, surfaces.lobes})
                pass.write(written, graph::Usage::storage_write);
        },
        [&scene, &lighting, surfaces, extent, leave = *pipeline](graph::PassContext& context) {
            const auto bindings = select_bindings(*leave, scene,
                                                  {{8, *lighting.frame},
                                                   {11, *lighting.shading_tables},
                                                   {12, gpu::Binding(context.image(surfaces.ids), lighting.nearest)},
                                                   {14, context.image(surfaces.places)},
                                                   {17, context.image(surfaces.albedos)},
                                                   {18, context.image(surfaces.lobes)},
                                                   {21, *lighting.volume->data}});
            context.commands.dispatch_threads(*leave, gpu::NoPushConstants{}, bindings, {extent.width, extent.height, 1});
        });
    return {};
}

graph::ImageHandle create_picture(graph::Graph& graph, VkExtent2D extent) {
    return image(graph, "radiance", VK_FORMAT_R32G32B32A32_SFLOAT, extent);
}

Result<void> add_shade(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                       const LightingInputs& lighting, graph::ImageHandle ids, const ShadowMaps& shadow_maps,
                       const VolumeImages& volume, graph::ImageHandle picture, VkExtent2D extent, const ShadeOptions& options) {
    gpu::Specialization constants = cone_constants(*lighting.volume, lighting.cone_shadows);
    const graph::ImageHandle traced_shadows = options.traced_shadows;
    if (traced_shadows) {
        constants[1] = options.shadow_spacing;
        constants[17] = 1;
    }
    const graph::ImageHandle shadowed = options.shadowed;
    if (shadowed) constants[20] = 1;
    constants[21] = options.maps_follow ? 1 : 0;
    constants[0] = options.aov ? 1 : 0;
    constants[2] = options.leaves ? 1 : 0;
    constants[19] = options.sky_follows ? 1 : 0;
    set_material_constants(constants, scene);
    set_light_constants(constants, scene);
    auto pipeline = pipelines.compute("passes/shade/shade.comp", constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    const Surfaces left = options.leaves ? *options.leaves : create_surfaces(graph, {ids, {}}, {1, 1});  // nothing writes those
    graph.add_pass(
        "shade", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(ids, graph::Usage::sampled);
            if (traced_shadows) pass.read(traced_shadows, graph::Usage::sampled);
            if (shadowed) pass.read(shadowed, graph::Usage::sampled);
            pass.read(shadow_maps.depth, graph::Usage::sampled);
            pass.read(shadow_maps.slope, graph::Usage::sampled);
            read_volume(pass, volume);
            for (const graph::ImageHandle written : {picture, left.places, left.albedos, left.lobes})
                pass.write(written, graph::Usage::storage_write);
        },
        [&scene, &lighting, ids, shadow_maps, traced_shadows, shadowed, left, picture, extent, shade = *pipeline](graph::PassContext& context) {
            const auto bindings = select_bindings(*shade, scene, with_volume(*lighting.volume,
                                                  {{8, *lighting.frame},
                                                   {9, *lighting.shadow_views},
                                                   {10, gpu::Binding(context.image(shadow_maps.depth), lighting.nearest)},
                                                   {15, gpu::Binding(context.image(shadow_maps.slope), lighting.nearest)},
                                                   {11, *lighting.shading_tables},
                                                   {24, *lighting.light_grid},
                                                   {16, *lighting.visible_lights},
                                                   {12, gpu::Binding(context.image(ids), lighting.nearest)},
                                                   {19, gpu::Binding(context.image(traced_shadows ? traced_shadows : ids), lighting.nearest)},
                                                   {29, gpu::Binding(context.image(shadowed ? shadowed : ids), lighting.nearest)},
                                                   {13, context.image(picture)},
                                                   {14, context.image(left.places)},
                                                   {17, context.image(left.albedos)},
                                                   {18, context.image(left.lobes)}}));
            context.commands.dispatch_threads(*shade, gpu::NoPushConstants{}, bindings, {extent.width, extent.height, 1});
        });
    return {};
}

}  // namespace heliodon::passes
