#include "passes/shadow_cones/shadow_cones.h"

#include <cstddef>

namespace heliodon::passes {

using graph::Usage;

Result<graph::ImageHandle> add_pixel_shadows(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                             const LightingInputs& lighting, graph::ImageHandle ids,
                                             const VolumeImages& volume, VkExtent2D extent, std::uint32_t spacing) {
    gpu::Specialization constants = cone_constants(*lighting.volume, lighting.cone_shadows);
    constants[1] = spacing;
    set_material_constants(constants, scene);
    set_light_constants(constants, scene);
    auto pipeline = pipelines.compute("passes/shadow_cones/shadow_pixels.comp", constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    const VkExtent3D cells{(extent.width + spacing - 1) / spacing, (extent.height + spacing - 1) / spacing, 1};
    const graph::ImageHandle traced =
        graph.create_image({.name = "traced shadows", .format = VK_FORMAT_R32G32B32A32_UINT, .extent = cells});
    graph.add_pass(
        "trace shadows", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(ids, Usage::sampled);
            read_volume(pass, volume);
            pass.write(traced, Usage::storage_write);
        },
        [&scene, &lighting, ids, traced, cells, shadows = *pipeline](graph::PassContext& context) {
            const auto bindings = select_bindings(*shadows, scene, with_volume(*lighting.volume,
                                                  {{8, *lighting.frame},
                                                   {12, gpu::Binding(context.image(ids), lighting.nearest)},
                                                   {13, context.image(traced)}}));
            context.commands.dispatch_threads(*shadows, gpu::NoPushConstants{}, bindings, {cells.width, cells.height, 1});
        });
    return traced;
}

Result<VoxelShadows> voxel_shadows(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                   const LightingInputs& lighting, const InjectCascade& cascade, const VolumeImages& images) {
    gpu::Specialization constants = cone_constants(*lighting.volume, lighting.cone_shadows);
    set_light_constants(constants, scene);
    auto pipeline = pipelines.compute("passes/shadow_cones/shadow_voxels.comp", constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    VoxelShadows result;
    result.shares = graph.create_buffer({"light shares of voxels", VkDeviceSize{cascade.surfaces.record_capacity} * sizeof(glm::uvec2)});
    result.uses = [cascade, images, shares = result.shares](graph::PassBuilder& pass) {
        pass.read(cascade.surfaces.numbers, Usage::storage_read);
        pass.read(cascade.surfaces.numbers, Usage::indirect);
        pass.read(cascade.surfaces.cells, Usage::storage_read);
        pass.read(cascade.surfaces.records, Usage::storage_read);
        read_volume(pass, images);
        pass.write(shares, Usage::storage_write);
    };
    result.record = [&scene, &lighting, cascade, shares = result.shares, shadows = *pipeline](graph::PassContext& context) {
        const gpu::Buffer& numbers = context.buffer(cascade.surfaces.numbers);
        const auto bindings = select_bindings(*shadows, scene, with_volume(*lighting.volume,
                                              {{16, numbers},
                                               {17, context.buffer(cascade.surfaces.cells)},
                                               {18, context.buffer(cascade.surfaces.records)},
                                               {19, context.buffer(shares)}}));
        context.commands.dispatch_indirect(*shadows, *cascade.constants, bindings, numbers, offsetof(shading::VoxelHeader, record_groups));
    };
    return result;
}

}  // namespace heliodon::passes
