#include "passes/cone_trace/cone_trace.h"

namespace heliodon::passes {
namespace {

using graph::Usage;

constexpr std::uint32_t spacing_constant = 1;  // of traced_pixels.glsl
constexpr std::uint32_t rows_constant = 2;     // of trace_pixels.comp
constexpr VkExtent2D tile{8, 4};               // traced pixels of a workgroup
// Of listed_pixels.glsl: where the lists' dispatch arguments stand, and in how many bytes.
constexpr VkDeviceSize unlike_diffuse_groups = 0, unlike_specular_groups = 16, transmissive_groups = 32, lists_header_bytes = 48;

/// What one frame's passes share.
struct ConeTrace {
    const SceneInputs& scene;
    const LightingInputs& lighting;
    const VolumeInputs& volume;
    VolumeImages images;
    Shaded shaded;
    VkExtent2D extent, cells;
    ConeTraceOptions options;
    graph::ImageHandle weights;
    graph::ImageHandle diffuse, specular;                       // of traced pixels
    graph::ImageHandle own_diffuse, own_specular, transmitted;  // of listed ones
    graph::BufferHandle listed;

    [[nodiscard]] gpu::Specialization constants() const {
        gpu::Specialization result = cone_constants(volume);
        result[0] = options.aov ? 1 : 0;
        result[spacing_constant] = options.spacing;
        set_material_constants(result, scene);
        return result;
    }
    void read_surfaces(graph::PassBuilder& pass) const {
        for (const graph::ImageHandle image : {shaded.places, shaded.albedos, shaded.lobes, shaded.ids}) pass.read(image, Usage::sampled);
        read_volume(pass, images);
    }
    /// Of `pipeline`: the scene's and the volume's with `own`.
    [[nodiscard]] std::vector<gpu::Binding> bindings(const gpu::Pipeline& pipeline, const graph::PassContext& context,
                                                     std::vector<NumberedBinding> own) const {
        own.insert(own.end(), {{8, *lighting.frame},
                               {11, *lighting.shading_tables},
                               {12, gpu::Binding(context.image(shaded.places), lighting.nearest)},
                               {18, gpu::Binding(context.image(shaded.albedos), lighting.nearest)},
                               {19, gpu::Binding(context.image(shaded.lobes), lighting.nearest)},
                               {17, context.buffer(listed)},
                               {20, gpu::Binding(context.image(images.faces), volume.trilinear)},
                               {21, *volume.data},
                               {22, gpu::Binding(context.image(images.depths), volume.trilinear)},
                               {23, *volume.occupancy},
                               {25, gpu::Binding(context.image(shaded.ids), lighting.nearest)}});
        return select_bindings(pipeline, scene, own);
    }
};

/// Who is like whom, and who traces cones.
Result<void> add_weights(graph::Graph& graph, gpu::Pipelines& pipelines, const ConeTrace& cones) {
    auto pipeline = pipelines.compute("passes/cone_trace/weigh_pixels.comp", cones.constants());
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "clear pixel lists", graph::PassKind::transfer,
        [&](graph::PassBuilder& pass) { pass.write(cones.listed, Usage::transfer_write); },
        [cones](graph::PassContext& context) { context.commands.fill(context.buffer(cones.listed), 0, 0, lists_header_bytes); });
    graph.add_pass(
        "weigh pixels", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            cones.read_surfaces(pass);
            pass.write(cones.weights, Usage::storage_write);
            pass.read_write(cones.listed, Usage::storage_read_write);
        },
        [cones, weigh = *pipeline](graph::PassContext& context) {
            const auto bindings = cones.bindings(*weigh, context, {{13, context.image(cones.weights)}});
            context.commands.dispatch_threads(*weigh, gpu::NoPushConstants{}, bindings,
                                              {cones.extent.width, cones.extent.height, 1});
        });
    return {};
}

/// All cones at once: each of the four dispatches writes what no other one does.
Result<void> add_cones(graph::Graph& graph, gpu::Pipelines& pipelines, const ConeTrace& cones) {
    gpu::Specialization constants = cones.constants();
    constants[rows_constant] = cones.options.spacing == 1 ? 2 : 5;
    auto traced = pipelines.compute("passes/cone_trace/trace_pixels.comp", constants);
    if (!traced) return tl::unexpected(traced.error());
    auto diffuse = pipelines.compute("passes/cone_trace/trace_diffuse.comp", cones.constants());
    if (!diffuse) return tl::unexpected(diffuse.error());
    auto specular = pipelines.compute("passes/cone_trace/trace_specular.comp", cones.constants());
    if (!specular) return tl::unexpected(specular.error());
    auto refracted = pipelines.compute("passes/cone_trace/trace_refracted.comp", cones.constants());
    if (!refracted) return tl::unexpected(refracted.error());
    graph.add_pass(
        "trace cones", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            cones.read_surfaces(pass);
            pass.read(cones.listed, Usage::storage_read);
            pass.read(cones.listed, Usage::indirect);
            for (const graph::ImageHandle image : {cones.diffuse, cones.specular, cones.own_diffuse, cones.own_specular, cones.transmitted})
                pass.write(image, Usage::storage_write);
        },
        [cones, traced = *traced, diffuse = *diffuse, specular = *specular, refracted = *refracted](graph::PassContext& context) {
            gpu::Commands& commands = context.commands;
            const auto trace_list = [&](const gpu::ComputePipeline& pipeline, graph::ImageHandle image, VkDeviceSize groups) {
                commands.dispatch_indirect(pipeline, gpu::NoPushConstants{}, cones.bindings(pipeline, context, {{13, context.image(image)}}),
                                           context.buffer(cones.listed), groups);
            };
            // The longest first.
            trace_list(*refracted, cones.transmitted, transmissive_groups);
            trace_list(*specular, cones.own_specular, unlike_specular_groups);
            trace_list(*diffuse, cones.own_diffuse, unlike_diffuse_groups);
            const glm::uvec3 groups{(cones.cells.width + tile.width - 1) / tile.width,
                                    (cones.cells.height + tile.height - 1) / tile.height, 1};
            commands.dispatch(*traced, gpu::NoPushConstants{},
                              cones.bindings(*traced, context,
                                             {{13, context.image(cones.diffuse)}, {14, context.image(cones.specular)}}), groups);
        });
    return {};
}

Result<void> add_resolve(graph::Graph& graph, gpu::Pipelines& pipelines, const ConeTrace& cones) {
    auto pipeline = pipelines.compute("passes/cone_trace/cone_trace.comp", cones.constants());
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "cone trace", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            cones.read_surfaces(pass);
            for (const graph::ImageHandle image :
                 {cones.weights, cones.diffuse, cones.specular, cones.own_diffuse, cones.own_specular, cones.transmitted})
                pass.read(image, Usage::sampled);
            pass.read_write(cones.shaded.picture, Usage::storage_read_write);
        },
        [cones, resolve = *pipeline](graph::PassContext& context) {
            const auto sampled = [&](graph::ImageHandle image) { return gpu::Binding(context.image(image), cones.lighting.nearest); };
            const auto bindings = cones.bindings(*resolve, context,
                                                 {{13, context.image(cones.shaded.picture)},
                                                  {14, sampled(cones.diffuse)},
                                                  {15, sampled(cones.specular)},
                                                  {16, sampled(cones.weights)},
                                                  {17, sampled(cones.transmitted)},
                                                  {27, sampled(cones.own_diffuse)},
                                                  {28, sampled(cones.own_specular)}});
            context.commands.dispatch_threads(*resolve, gpu::NoPushConstants{}, bindings,
                                              {cones.extent.width, cones.extent.height, 1});
        });
    return {};
}

}  // namespace

Result<void> add_cone_trace(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                            const LightingInputs& lighting, const VolumeInputs& volume, const VolumeImages& images,
                            const Shaded& shaded, VkExtent2D extent, const ConeTraceOptions& options) {
    const VkExtent2D cells{(extent.width + options.spacing - 1) / options.spacing,
                           (extent.height + options.spacing - 1) / options.spacing};
    const auto image = [&](const char* name, VkFormat format, VkExtent2D size) {
        return graph.create_image({.name = name, .format = format, .extent = {size.width, size.height, 1}});
    };
    const VkDeviceSize list_bytes = VkDeviceSize{extent.width} * extent.height * sizeof(std::uint32_t);
    const ConeTrace cones{.scene = scene,
                          .lighting = lighting,
                          .volume = volume,
                          .images = images,
                          .shaded = shaded,
                          .extent = extent,
                          .cells = cells,
                          .options = options,
                          .weights = image("weights of traced pixels", VK_FORMAT_R32G32_UINT, extent),
                          .diffuse = image("traced diffuse", VK_FORMAT_R16G16B16A16_SFLOAT, cells),
                          .specular = image("traced specular", VK_FORMAT_R16G16B16A16_SFLOAT, cells),
                          .own_diffuse = image("diffuse of unlike pixels", VK_FORMAT_R16G16B16A16_SFLOAT, extent),
                          .own_specular = image("specular of unlike pixels", VK_FORMAT_R16G16B16A16_SFLOAT, extent),
                          .transmitted = image("transmitted", VK_FORMAT_R16G16B16A16_SFLOAT, extent),
                          .listed = graph.create_buffer({"listed pixels", lists_header_bytes + 3 * list_bytes})};
    return add_weights(graph, pipelines, cones)
        .and_then([&] { return add_cones(graph, pipelines, cones); })
        .and_then([&] { return add_resolve(graph, pipelines, cones); });
}

}  // namespace heliodon::passes
