#include "passes/shadow_volumes/shadow_volumes.h"

#include "passes/common/frame_shared.h"
#include "passes/common/raster.h"

namespace heliodon::passes {
namespace {

using shading::VolumeConstants;

constexpr VkFormat volume_depth_format = VK_FORMAT_D32_SFLOAT_S8_UINT;
constexpr VkFormat shadowed_format = VK_FORMAT_R8_UINT;

gpu::GraphicsDescription description_of(const char* name, const char* vertex, const char* fragment = "") {
    auto description = raster_description(name, std::string("passes/shadow_volumes/") + vertex,
                                          *fragment ? std::string("passes/shadow_volumes/") + fragment : std::string());
    description.depth_format = volume_depth_format;
    return description;
}

/// Counts what lies beyond the surface, or in it: leaving a volume adds one, entering takes one away. A surface that is
/// itself a volume's cap enters it there, and stands outside. `turned`: corners go round as seen from inside.
gpu::GraphicsDescription counting(gpu::GraphicsDescription description, bool turned = false) {
    const gpu::StencilSide entering{.depth_fail = VK_STENCIL_OP_DECREMENT_AND_WRAP};
    const gpu::StencilSide leaving{.depth_fail = VK_STENCIL_OP_INCREMENT_AND_WRAP};
    description.stencil = turned ? gpu::StencilTest{leaving, entering} : gpu::StencilTest{entering, leaving};
    description.depth_write = false;
    description.color_formats = {shadowed_format};
    description.blend = {gpu::Blend::keep};
    return description;
}

struct VolumePipelines {
    const gpu::GraphicsPipeline *opaque = nullptr, *tested = nullptr, *sides = nullptr, *toward = nullptr,
                                *away = nullptr, *shadowed = nullptr;

    [[nodiscard]] Result<void> open(gpu::Pipelines& pipelines) {
        auto shadowed_description = counting(description_of("volume shadowed", "shadowed.vert", "shadowed.frag"));
        shadowed_description.stencil = {{VK_COMPARE_OP_NOT_EQUAL}, {VK_COMPARE_OP_NOT_EQUAL}};
        shadowed_description.depth_test = false;
        shadowed_description.blend = {gpu::Blend::none};
        const std::pair<const gpu::GraphicsPipeline**, gpu::GraphicsDescription> wanted[] = {
            {&opaque, description_of("volume depth", "depth.vert")},
            {&tested, description_of("volume depth tested", "depth_tested.vert", "depth_tested.frag")},
            {&sides, counting(description_of("volume sides", "side.vert"))},
            {&toward, counting(description_of("volume caps", "cap.vert"))},
            {&away, counting(description_of("volume caps turned", "cap.vert"), true)},
            {&shadowed, shadowed_description}};
        for (const auto& [pipeline, description] : wanted) {
            auto made = pipelines.graphics(description);
            if (!made) return tl::unexpected(made.error());
            *pipeline = *made;
        }
        return {};
    }
};

VolumeConstants constants_of(const ShadowVolumeInputs& inputs, std::uint32_t first_cap = 0) {
    return {inputs.world_to_clip, inputs.sun, first_cap};
}

void draw_volumes(gpu::Commands& commands, const SceneInputs& scene, const ShadowVolumeInputs& inputs,
                  const VolumePipelines& pipelines) {
    const auto draw = [&](const gpu::GraphicsPipeline& pipeline, const gpu::Buffer& list, std::uint32_t first,
                          std::uint32_t kind) {
        commands.bind(pipeline, constants_of(inputs, first), select_bindings(pipeline, scene, {{8, list}}));
        commands.draw_indirect(*inputs.draws, kind * sizeof(shading::VolumeDraw), 1);
    };
    draw(*pipelines.sides, *inputs.sides, 0, shading::volume_draw_sides);
    draw(*pipelines.toward, *inputs.caps, 0, shading::volume_draw_toward);
    draw(*pipelines.away, *inputs.caps, inputs.cap_capacity, shading::volume_draw_away);
}

}  // namespace

static_assert(sizeof(shading::VolumeDraw) == sizeof(VkDrawIndirectCommand));

Result<graph::ImageHandle> add_shadow_volumes(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene,
                                              const ShadowVolumeInputs& inputs, const DrawLists& lists,
                                              VkExtent2D extent) {
    VolumePipelines drawn;
    if (auto done = drawn.open(pipelines); !done) return tl::unexpected(done.error());
    const VkExtent3D size{extent.width, extent.height, 1};
    const auto depth = graph.create_image({.name = "volume depth", .format = volume_depth_format, .extent = size});
    const auto shadowed = graph.create_image({.name = "shadowed", .format = shadowed_format, .extent = size});
    graph.add_pass(
        "shadow volume depth", graph::PassKind::graphics,
        [&](graph::PassBuilder& pass) {
            pass.read(lists.commands, graph::Usage::indirect);
            pass.read(lists.counts, graph::Usage::indirect);
            pass.write(depth, graph::Usage::depth_stencil_attachment);
        },
        [&scene, &inputs, lists, depth, drawn](graph::PassContext& context) {
            gpu::Rendering rendering;
            rendering.depth = gpu::DepthAttachment{.view = {&context.image(depth)}, .clear = 0.0f};
            context.commands.begin_rendering(rendering);
            const auto draw = [&](const gpu::GraphicsPipeline& pipeline, std::uint32_t list) {
                context.commands.bind(pipeline, constants_of(inputs), select_bindings(pipeline, scene, {}));
                draw_list(context, scene, lists, 0, list);
            };
            draw(*drawn.opaque, shading::draw_list_opaque);
            if (scene.has_tested) draw(*drawn.tested, shading::draw_list_tested);
            context.commands.end_rendering();
        });
    graph.add_pass(
        "shadow volumes", graph::PassKind::graphics,
        [&](graph::PassBuilder& pass) {
            pass.read_write(depth, graph::Usage::depth_stencil_attachment);
            pass.write(shadowed, graph::Usage::color_attachment);
        },
        [&scene, &inputs, depth, shadowed, drawn](graph::PassContext& context) {
            gpu::Rendering rendering;
            rendering.color.push_back({.view = {&context.image(shadowed)}});
            rendering.depth = gpu::DepthAttachment{.view = {&context.image(depth)}, .load = VK_ATTACHMENT_LOAD_OP_LOAD};
            context.commands.begin_rendering(rendering);
            draw_volumes(context.commands, scene, inputs, drawn);
            context.commands.bind(*drawn.shadowed, gpu::NoPushConstants{}, std::span<const gpu::Binding>{});
            context.commands.draw(3);
            context.commands.end_rendering();
        });
    return shadowed;
}

}  // namespace heliodon::passes
