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
            // Maps that are not drawn now stay.
            pass.read_write(maps.depth, graph::Usage::depth_attachment);
            pass.read_write(maps.slope, graph::Usage::color_attachment);
        },
        [&scene, &inputs, lists, maps, opaque = *opaque, tested = *tested](graph::PassContext& context) {
            const auto draw_view = [&](const gpu::GraphicsPipeline& pipeline, std::uint32_t view, std::uint32_t list) {
                context.commands.bind(pipeline, RasterConstants{view, inputs.random_seed},
                                      select_bindings(pipeline, scene, {{8, *inputs.views}}));
                draw_list(context, scene, lists, view, list);
            };
            for (const ShadowDraw& draw : inputs.draws) {
                gpu::Rendering rendering;
                rendering.area = draw.area;
                rendering.depth = gpu::DepthAttachment{.view = context.image(maps.depth).layer(draw.layer), .clear = 0.0f};
                // Where nothing stands the slope is never looked at.
                rendering.color.push_back({.view = context.image(maps.slope).layer(draw.layer), .load = VK_ATTACHMENT_LOAD_OP_DONT_CARE});
                context.commands.begin_rendering(rendering);
                draw_view(*opaque, draw.view, shading::draw_list_opaque);
                if (scene.has_tested || scene.has_blended) draw_view(*tested, draw.view, shading::draw_list_tested);
                context.commands.end_rendering();
            }
        });
    return {};
}

}  // namespace heliodon::passes
