#include "passes/occupancy/occupancy.h"

#include <cstddef>
#include <vector>

#include "passes/occupancy/occupancy_shared.h"

namespace heliodon::passes {
namespace {

using graph::Usage;

void mark_levels(graph::PassContext& context, const gpu::ComputePipeline& mark, const InjectCascade& widest, const VolumeImages& images) {
    const VoxelSurfaces& surfaces = widest.surfaces;
    const gpu::Buffer& lists = context.buffer(surfaces.levels);
    for (std::uint32_t level = 1; level < shading::occupancy_levels(surfaces.size); ++level) {
        const shading::FilterConstants constants{level, surfaces.size, widest.constants->cascade,
                                                 shading::voxel_level_first(level, surfaces.size, surfaces.record_capacity)};
        context.commands.dispatch_indirect(mark, constants, {lists, context.image(images.faces).mip(level), context.buffer(images.occupancy)},
                                           lists, level * sizeof(glm::uvec4));
    }
}

}  // namespace

VkDeviceSize occupancy_bytes(std::uint32_t size, std::uint32_t cascades) {
    const std::uint32_t levels = shading::occupancy_levels(size);
    return 4 * VkDeviceSize{shading::occupancy_first(size, cascades - 1, levels > 0 ? levels : 1)} + 4;
}

Result<void> add_occupancy(graph::Graph& graph, gpu::Pipelines& pipelines, std::span<const InjectCascade> cascades,
                           const VolumeImages& images) {
    auto records = pipelines.compute("passes/occupancy/occupancy_records.comp");
    if (!records) return tl::unexpected(records.error());
    auto levels = pipelines.compute("passes/occupancy/occupancy_levels.comp");
    if (!levels) return tl::unexpected(levels.error());
    graph.add_pass(
        "occupancy clear", graph::PassKind::transfer,
        [&](graph::PassBuilder& pass) { pass.write(images.occupancy, Usage::transfer_write); },
        [images, outdated = cascades.front().outdated](graph::PassContext& context) {
            if (*outdated) context.commands.fill(context.buffer(images.occupancy), 0);
        });
    graph.add_pass(
        "occupancy", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            for (const InjectCascade& cascade : cascades) {
                for (const graph::BufferHandle list : {cascade.surfaces.numbers, cascade.surfaces.levels}) {
                    pass.read(list, Usage::storage_read);
                    pass.read(list, Usage::indirect);
                }
                pass.read(cascade.surfaces.cells, Usage::storage_read);
                pass.read(cascade.surfaces.records, Usage::storage_read);
            }
            pass.read_write(images.faces, Usage::storage_read_write);  // it may have nothing to read: what wrote them stays to be waited for
            pass.read_write(images.occupancy, Usage::storage_read_write);
        },
        [all = std::vector(cascades.begin(), cascades.end()), images, records = *records, levels = *levels](graph::PassContext& context) {
            if (!*all.front().outdated) return;
            for (const InjectCascade& cascade : all) {
                const gpu::Buffer& numbers = context.buffer(cascade.surfaces.numbers);
                context.commands.dispatch_indirect(*records, *cascade.constants,
                                                   {numbers, context.buffer(cascade.surfaces.cells), context.buffer(cascade.surfaces.records),
                                                    context.image(images.faces).mip(0), context.buffer(images.occupancy)},
                                                   numbers, offsetof(shading::VoxelHeader, record_groups));
            }
            mark_levels(context, *levels, all.back(), images);
        });
    return {};
}

}  // namespace heliodon::passes
