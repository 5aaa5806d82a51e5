#include "passes/blend/blend.h"

#include "passes/blend/blend_shared.h"
#include "passes/common/frame_shared.h"
#include "passes/common/raster.h"

namespace heliodon::passes {

using graph::PassBuilder;
using graph::PassContext;
using graph::PassKind;
using graph::Usage;

VkDeviceSize blend_buffer_bytes(std::uint32_t capacity) {
    return 16 + VkDeviceSize{capacity} * sizeof(shading::BlendFragment);
}

Result<void> add_blend(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene, const LightingInputs& lighting,
                       const gpu::Buffer& views, const DrawLists& lists, const Visibility& visibility,
                       const ShadowMaps& shadow_maps, const VolumeImages& volume, graph::BufferHandle fragments,
                       graph::ImageHandle picture, VkExtent2D extent, bool cone_traced) {
    auto description = raster_description("blend lists", "passes/common/opaque.vert", "passes/blend/blend_lists.frag");
    description.depth_write = false;
    auto collect = pipelines.graphics(description);
    if (!collect) return tl::unexpected(collect.error());
    gpu::Specialization constants = cone_constants(*lighting.volume, lighting.cone_shadows);
    constants[1] = cone_traced ? 1 : 0;
    set_material_constants(constants, scene);
    set_light_constants(constants, scene);
    auto compose = pipelines.compute("passes/blend/blend.comp", constants);
    if (!compose) return tl::unexpected(compose.error());

    const graph::BufferHandle heads =
        graph.create_buffer({"blend heads", VkDeviceSize{extent.width} * extent.height * sizeof(std::uint32_t)});
    graph.add_pass(
        "blend clear", PassKind::transfer,
        [&](PassBuilder& pass) {
            pass.write(heads, Usage::transfer_write);
            pass.read_write(fragments, Usage::transfer_write);
        },
        [heads, fragments](PassContext& context) {
            context.commands.fill(context.buffer(heads), 0);
            context.commands.fill(context.buffer(fragments), 0, 0, 4);
        });
    graph.add_pass(
        "blend lists", PassKind::graphics,
        [&](PassBuilder& pass) {
            pass.read(lists.commands, Usage::indirect);
            pass.read(lists.counts, Usage::indirect);
            pass.read(visibility.depth, Usage::depth_read);
            pass.read_write(heads, Usage::storage_read_write);
            pass.read_write(fragments, Usage::storage_read_write);
        },
        [&scene, &lighting, &views, lists, visibility, heads, fragments, extent, collect = *collect](PassContext& context) {
            gpu::Rendering rendering;
            rendering.depth = gpu::DepthAttachment{
                .view = {&context.image(visibility.depth)}, .load = VK_ATTACHMENT_LOAD_OP_LOAD, .read_only = true};
            rendering.area = VkRect2D{{0, 0}, extent};
            context.commands.begin_rendering(rendering);
            context.commands.bind(*collect, RasterConstants{},
                                  select_bindings(*collect, scene, {{8, views}, {9, *lighting.frame},
                                                                    {10, context.buffer(fragments)}, {11, context.buffer(heads)}}));
            draw_list(context, scene, lists, 0, shading::draw_list_blended);
            context.commands.end_rendering();
        });
    graph.add_pass(
        "blend", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read(heads, Usage::storage_read);
            pass.read_write(fragments, Usage::storage_read_write);
            pass.read(shadow_maps.depth, Usage::sampled);
            pass.read(shadow_maps.slope, Usage::sampled);
            read_volume(pass, volume);
            pass.read_write(picture, Usage::storage_read_write);
        },
        [&scene, &lighting, shadow_maps, heads, fragments, picture, extent, compose = *compose](PassContext& context) {
            const auto bindings = select_bindings(*compose, scene, with_volume(*lighting.volume,
                                                  {{8, *lighting.frame},
                                                   {9, *lighting.shadow_views},
                                                   {10, gpu::Binding(context.image(shadow_maps.depth), lighting.nearest)},
                                                   {15, gpu::Binding(context.image(shadow_maps.slope), lighting.nearest)},
                                                   {11, *lighting.shading_tables},
                                                   {24, *lighting.light_grid},
                                                   {16, *lighting.visible_lights},
                                                   {12, context.buffer(fragments)},
                                                   {13, context.buffer(heads)},
                                                   {14, context.image(picture)}}));
            context.commands.dispatch_threads(*compose, gpu::NoPushConstants{}, bindings, {extent.width, extent.height, 1});
        });
    return {};
}

}  // namespace heliodon::passes
