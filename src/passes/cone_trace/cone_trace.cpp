#include "passes/cone_trace/cone_trace.h"

namespace heliodon::passes {
namespace {

using graph::Usage;

constexpr std::uint32_t spacing_constant = 1;  // of traced_pixels.glsl
constexpr std::uint32_t rows_constant = 2;     // of trace_pixels.comp
constexpr VkExtent2D tile{8, 4};               // traced pixels of a workgroup
// Of listed_pixels.glsl: where the lists' dispatch arguments stand, and in how many bytes.
constexpr VkDeviceSize unlike_diffuse_groups = 0, unlike_specular_groups = 16, transmissive_groups = 32, lists_header_bytes = 48;

void read_surfaces(graph::PassBuilder& pass, const Surfaces& surfaces) {
    for (const graph::ImageHandle image : {surfaces.places, surfaces.albedos, surfaces.lobes, surfaces.ids}) pass.read(image, Usage::sampled);
}

/// `own` with the surfaces'.
std::vector<NumberedBinding> surface_bindings(const graph::PassContext& context, const LightingInputs& lighting,
                                              const Surfaces& surfaces, const ConeWeights& weights, std::vector<NumberedBinding> own) {
    own.insert(own.end(), {{8, *lighting.frame},
                           {11, *lighting.shading_tables},
                           {12, gpu::Binding(context.image(surfaces.places), lighting.nearest)},
                           {18, gpu::Binding(context.image(surfaces.albedos), lighting.nearest)},
                           {19, gpu::Binding(context.image(surfaces.lobes), lighting.nearest)},
                           {17, context.buffer(weights.listed)},
                           {25, gpu::Binding(context.image(surfaces.ids), lighting.nearest)}});
    return own;
}

gpu::Specialization constants_of(const ConeTrace& cones) {
    gpu::Specialization result = cone_constants(cones.volume);
    result[0] = cones.options.aov ? 1 : 0;
    result[spacing_constant] = cones.options.spacing;
    set_material_constants(result, cones.scene);
    return result;
}

void read_surfaces_and_volume(graph::PassBuilder& pass, const ConeTrace& cones) {
    read_surfaces(pass, cones.surfaces);
    read_volume(pass, cones.images);
}

/// Of `pipeline`: the scene's and the volume's with `own`.
std::vector<gpu::Binding> bindings_of(const ConeTrace& cones, const gpu::Pipeline& pipeline, const graph::PassContext& context,
                                      std::vector<NumberedBinding> own) {
    return select_bindings(pipeline, cones.scene,
                           with_volume(cones.volume, surface_bindings(context, cones.lighting, cones.surfaces, cones.weights, std::move(own))));
}

}  // namespace

Result<ConeWeights> add_cone_weights(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                     const LightingInputs& lighting, const Surfaces& surfaces, VkExtent2D extent,
                                     const ConeTraceOptions& options) {
    gpu::Specialization constants{{spacing_constant, options.spacing}};
    set_material_constants(constants, scene);
    auto pipeline = pipelines.compute("passes/cone_trace/weigh_pixels.comp", constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    const VkDeviceSize list_bytes = VkDeviceSize{extent.width} * extent.height * sizeof(std::uint32_t);
    const ConeWeights result{graph.create_image({.name = "weights of traced pixels", .format = VK_FORMAT_R32G32_UINT,
                                                 .extent = {extent.width, extent.height, 1}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT}),
                             graph.create_buffer({"listed pixels", lists_header_bytes + 3 * list_bytes, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT})};
    graph.add_pass(
        "clear pixel lists", graph::PassKind::transfer,
        [&](graph::PassBuilder& pass) { pass.write(result.listed, Usage::transfer_write); },
        [result](graph::PassContext& context) { context.commands.fill(context.buffer(result.listed), 0, 0, lists_header_bytes); });
    graph.add_pass(
        "weigh pixels", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            read_surfaces(pass, surfaces);
            pass.write(result.weights, Usage::storage_write);
            pass.read_write(result.listed, Usage::storage_read_write);
        },
        [&scene, &lighting, surfaces, result, extent, weigh = *pipeline](graph::PassContext& context) {
            const auto bindings = select_bindings(*weigh, scene,
                                                  with_volume(*lighting.volume, surface_bindings(context, lighting, surfaces, result,
                                                                                                 {{13, context.image(result.weights)}})));
            context.commands.dispatch_threads(*weigh, gpu::NoPushConstants{}, bindings, {extent.width, extent.height, 1});
        });
    return result;
}

Result<TracedCones> add_cones(graph::Graph& graph, gpu::Pipelines& pipelines, const ConeTrace& cones) {
    gpu::Specialization constants = constants_of(cones);
    auto diffuse = pipelines.compute("passes/cone_trace/trace_diffuse.comp", constants);
    if (!diffuse) return tl::unexpected(diffuse.error());
    auto specular = pipelines.compute("passes/cone_trace/trace_specular.comp", constants);
    if (!specular) return tl::unexpected(specular.error());
    auto refracted = pipelines.compute("passes/cone_trace/trace_refracted.comp", constants);
    if (!refracted) return tl::unexpected(refracted.error());
    constants[rows_constant] = cones.options.spacing == 1 ? 2 : 5;
    auto all = pipelines.compute("passes/cone_trace/trace_pixels.comp", constants);
    if (!all) return tl::unexpected(all.error());
    const std::uint32_t spacing = cones.options.spacing;
    const VkExtent2D cells{(cones.extent.width + spacing - 1) / spacing, (cones.extent.height + spacing - 1) / spacing};
    const auto image = [&](const char* name, VkExtent2D size) {
        return graph.create_image({.name = name, .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = {size.width, size.height, 1}});
    };
    const TracedCones traced{.diffuse = image("traced diffuse", cells),
                             .specular = image("traced specular", cells),
                             .own_diffuse = image("diffuse of unlike pixels", cones.extent),
                             .own_specular = image("specular of unlike pixels", cones.extent),
                             .transmitted = image("transmitted", cones.extent)};
    // All cones at once: each of the four dispatches writes what no other one does.
    graph.add_pass(
        "trace cones", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            read_surfaces_and_volume(pass, cones);
            pass.read(cones.weights.listed, Usage::storage_read);
            pass.read(cones.weights.listed, Usage::indirect);
            for (const graph::ImageHandle image :
                 {traced.diffuse, traced.specular, traced.own_diffuse, traced.own_specular, traced.transmitted})
                pass.write(image, Usage::storage_write);
        },
        [cones, traced, cells, all = *all, diffuse = *diffuse, specular = *specular, refracted = *refracted](graph::PassContext& context) {
            gpu::Commands& commands = context.commands;
            const auto trace_list = [&](const gpu::ComputePipeline& pipeline, graph::ImageHandle image, VkDeviceSize groups) {
                commands.dispatch_indirect(pipeline, gpu::NoPushConstants{}, bindings_of(cones, pipeline, context, {{13, context.image(image)}}),
                                           context.buffer(cones.weights.listed), groups);
            };
            // The longest first.
            trace_list(*refracted, traced.transmitted, transmissive_groups);
            trace_list(*specular, traced.own_specular, unlike_specular_groups);
            trace_list(*diffuse, traced.own_diffuse, unlike_diffuse_groups);
            const glm::uvec3 groups{(cells.width + tile.width - 1) / tile.width, (cells.height + tile.height - 1) / tile.height, 1};
            commands.dispatch(*all, gpu::NoPushConstants{},
                              bindings_of(cones, *all, context, {{13, context.image(traced.diffuse)}, {14, context.image(traced.specular)}}),
                              groups);
        });
    return traced;
}

Result<void> add_cone_light(graph::Graph& graph, gpu::Pipelines& pipelines, const ConeTrace& cones, const TracedCones& traced,
                            graph::ImageHandle picture) {
    auto pipeline = pipelines.compute("passes/cone_trace/cone_trace.comp", constants_of(cones));
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "cone trace", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            read_surfaces_and_volume(pass, cones);
            for (const graph::ImageHandle image : {cones.weights.weights, traced.diffuse, traced.specular, traced.own_diffuse,
                                                   traced.own_specular, traced.transmitted})
                pass.read(image, Usage::sampled);
            pass.read_write(picture, Usage::storage_read_write);
        },
        [cones, traced, picture, add = *pipeline](graph::PassContext& context) {
            const auto sampled = [&](graph::ImageHandle image) { return gpu::Binding(context.image(image), cones.lighting.nearest); };
            const auto bindings = bindings_of(cones, *add, context,
                                              {{13, context.image(picture)},
                                               {14, sampled(traced.diffuse)},
                                               {15, sampled(traced.specular)},
                                               {16, sampled(cones.weights.weights)},
                                               {17, sampled(traced.transmitted)},
                                               {27, sampled(traced.own_diffuse)},
                                               {28, sampled(traced.own_specular)}});
            context.commands.dispatch_threads(*add, gpu::NoPushConstants{}, bindings, {cones.extent.width, cones.extent.height, 1});
        });
    return {};
}

}  // namespace heliodon::passes
