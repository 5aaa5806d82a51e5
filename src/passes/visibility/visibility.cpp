#include "passes/visibility/visibility.h"

#include "passes/common/frame_shared.h"
#include "passes/common/raster.h"

namespace heliodon::passes {

Result<Visibility> add_visibility(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene,
                                  const gpu::Buffer& views, const DrawLists& lists, VkExtent2D extent) {
    auto description = raster_description("visibility opaque", "passes/common/opaque.vert", "passes/visibility/visibility.frag");
    description.color_formats = {VK_FORMAT_R32G32_UINT};
    auto opaque = pipelines.graphics(description);
    if (!opaque) return tl::unexpected(opaque.error());
    description.name = "visibility tested";
    description.vertex = "passes/common/tested.vert";
    description.fragment = "passes/visibility/visibility_tested.frag";
    auto tested = pipelines.graphics(description);
    if (!tested) return tl::unexpected(tested.error());

    Visibility result;
    const VkExtent3D size{extent.width, extent.height, 1};
    result.ids = graph.create_image({.name = "visibility", .format = VK_FORMAT_R32G32_UINT, .extent = size});
    result.depth = graph.create_image({.name = "depth", .format = VK_FORMAT_D32_SFLOAT, .extent = size});
    graph.add_pass(
        "visibility", graph::PassKind::graphics,
        [&](graph::PassBuilder& pass) {
            pass.read(lists.commands, graph::Usage::indirect);
            pass.read(lists.counts, graph::Usage::indirect);
            pass.write(result.ids, graph::Usage::color_attachment);
            pass.write(result.depth, graph::Usage::depth_attachment);
        },
        [&scene, &views, lists, result, opaque = *opaque, tested = *tested](graph::PassContext& context) {
            gpu::Rendering rendering;
            rendering.color.push_back({.view = {&context.image(result.ids)}});
            rendering.depth = gpu::DepthAttachment{.view = {&context.image(result.depth)}, .clear = 0.0f};
            context.commands.begin_rendering(rendering);
            const RasterConstants push{};
            context.commands.bind(*opaque, push, select_bindings(*opaque, scene, {{8, views}}));
            draw_list(context, scene, lists, 0, shading::draw_list_opaque);
            if (scene.has_tested) {
                context.commands.bind(*tested, push, select_bindings(*tested, scene, {{8, views}}));
                draw_list(context, scene, lists, 0, shading::draw_list_tested);
            }
            context.commands.end_rendering();
        });
    return result;
}

}  // namespace heliodon::passes
