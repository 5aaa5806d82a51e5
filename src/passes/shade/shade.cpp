#include "passes/shade/shade.h"

#include "passes/shadow_cones/shadow_cones.h"

namespace heliodon::passes {

Result<Shaded> add_shade(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                         const LightingInputs& lighting, const Visibility& visibility, const ShadowMaps& shadow_maps,
                         const VolumeImages& volume, VkExtent2D extent, const ShadeOptions& options) {
    gpu::Specialization constants = cone_constants(*lighting.volume, lighting.cone_shadows);
    graph::ImageHandle traced_shadows;
    if (lighting.shadows_traced && !options.aov) {
        auto traced = add_pixel_shadows(graph, pipelines, scene, lighting, visibility, volume, extent, options.shadow_spacing);
        if (!traced) return tl::unexpected(traced.error());
        traced_shadows = *traced;
        constants[1] = options.shadow_spacing;
        constants[17] = 1;
    }
    constants[0] = options.aov ? 1 : 0;
    constants[2] = options.cones_follow ? 1 : 0;
    set_material_constants(constants, scene);
    set_light_constants(constants, scene);
    auto pipeline = pipelines.compute("passes/shade/shade.comp", constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    const auto image = [&](const char* name, VkFormat format, VkExtent2D size) {
        return graph.create_image({.name = name, .format = format, .extent = {size.width, size.height, 1}});
    };
    const VkExtent2D left = options.cones_follow ? extent : VkExtent2D{1, 1};
    const Shaded shaded{.picture = image("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, extent),
                        .places = image("surface places", VK_FORMAT_R32G32B32A32_UINT, left),
                        .albedos = image("surface albedos", VK_FORMAT_R32G32B32A32_UINT, left),
                        .lobes = image("surface lobes", VK_FORMAT_R32_UINT, left),
                        .ids = visibility.ids};
    graph.add_pass(
        "shade", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(visibility.ids, graph::Usage::sampled);
            if (traced_shadows) pass.read(traced_shadows, graph::Usage::sampled);
            pass.read(shadow_maps.depth, graph::Usage::sampled);
            pass.read(shadow_maps.slope, graph::Usage::sampled);
            read_volume(pass, volume);
            for (const graph::ImageHandle written : {shaded.picture, shaded.places, shaded.albedos, shaded.lobes})
                pass.write(written, graph::Usage::storage_write);
        },
        [&scene, &lighting, visibility, shadow_maps, traced_shadows, shaded, extent, shade = *pipeline](graph::PassContext& context) {
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
                                                   {23, *lighting.volume->occupancy},
                                                   {12, gpu::Binding(context.image(visibility.ids), lighting.nearest)},
                                                   {19, gpu::Binding(context.image(traced_shadows ? traced_shadows : visibility.ids), lighting.nearest)},
                                                   {13, context.image(shaded.picture)},
                                                   {14, context.image(shaded.places)},
                                                   {17, context.image(shaded.albedos)},
                                                   {18, context.image(shaded.lobes)}});
            context.commands.dispatch_threads(*shade, gpu::NoPushConstants{}, bindings, {extent.width, extent.height, 1});
        });
    return shaded;
}

}  // namespace heliodon::passes
