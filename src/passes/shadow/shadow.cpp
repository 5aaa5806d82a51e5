#include "passes/shadow/shadow.h"

#include "passes/common/frame_shared.h"
#include "passes/common/raster.h"

namespace heliodon::passes {

Result<void> add_shadow(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene, const ShadowInputs& inputs,
                        const DrawLists& lists, const ShadowMaps& maps) {
    auto description = raster_description("shadow opaque", "passes/common/opaque.vert", "passes/shadow/shadow_opaque.frag");
    description.color_formats = {shadow_slope_format};
    auto opaque = pipelines.graphics(description);
    if (!opaque) return tl::unexpected(opaque.error());
    description = raster_description("shadow tested", "passes/common/tested.vert", "passes/shadow/shadow_tested.frag");
    description.color_formats = {shadow_slope_format};
    auto tested = pipelines.graphics(description);
    if (!tested) return tl::unexpected(tested.error());

    graph.add_pass(
        "shadow", graph::PassKind::graphics,
        [&](graph::PassBuilder& pass) {
            pass.read(lists.commands, graph::Usage::indirect);
            pass.read(lists.counts, graph::Usage::indirect);
            pass.write(maps.depth, graph::Usage::depth_attachment);
            pass.write(maps.slope, graph::Usage::color_attachment);
        },
        [&scene, &inputs, lists, maps, opaque = *opaque, tested = *tested](graph::PassContext& context) {
            for (std::uint32_t view = 0; view < inputs.view_count; ++view) {
                gpu::Rendering rendering;
                rendering.depth = gpu::DepthAttachment{.view = context.image(maps.depth).layer(view), .clear = 0.0f};
                // Where nothing stands the slope is never looked at.
                rendering.color.push_back({.view = context.image(maps.slope).layer(view), .load = VK_ATTACHMENT_LOAD_OP_DONT_CARE});
                context.commands.begin_rendering(rendering);
                const RasterConstants push{view, inputs.random_seed};
                context.commands.bind(*opaque, push, select_bindings(*opaque, scene, {{8, *inputs.views}}));
                draw_list(context, scene, lists, view, shading::draw_list_opaque);
                if (scene.has_tested || scene.has_blended) {
                    context.commands.bind(*tested, push, select_bindings(*tested, scene, {{8, *inputs.views}}));
                    draw_list(context, scene, lists, view, shading::draw_list_tested);
                }
                context.commands.end_rendering();
            }
        });
    return {};
}

}  // namespace heliodon::passes
