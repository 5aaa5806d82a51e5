#include "passes/occupancy/occupancy.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "passes/occupancy/occupancy_shared.h"

namespace heliodon::passes {
namespace {

using graph::Usage;

void mark_voxels(graph::PassContext& context, const gpu::ComputePipeline& mark, std::span<const InjectCascade> cascades,
                 const VolumeImages& images, graph::BufferHandle occupied) {
    for (const InjectCascade& cascade : cascades) {
        const gpu::Buffer& numbers = context.buffer(cascade.surfaces.numbers);
        context.commands.dispatch_indirect(mark, *cascade.constants,
                                           {numbers, context.buffer(cascade.surfaces.cells), context.buffer(cascade.surfaces.records),
                                            context.image(images.faces).mip(0), context.buffer(occupied)},
                                           numbers, offsetof(shading::VoxelHeader, record_groups));
    }
}

void mark_levels(graph::PassContext& context, const gpu::ComputePipeline& mark, const InjectCascade& widest, const VolumeImages& images,
                 graph::BufferHandle occupied) {
    const VoxelSurfaces& surfaces = widest.surfaces;
    const gpu::Buffer& lists = context.buffer(surfaces.levels);
    for (std::uint32_t level = 1; level < shading::occupancy_levels(surfaces.size); ++level) {
        const shading::FilterConstants constants{level, surfaces.size, widest.constants->cascade,
                                                 shading::voxel_level_first(level, surfaces.size, surfaces.record_capacity)};
        context.commands.dispatch_indirect(mark, constants, {lists, context.image(images.faces).mip(level), context.buffer(occupied)},
                                           lists, level * sizeof(glm::uvec4));
    }
}

/// From the widest cascade inwards: each one asks the next.
void count_empty(graph::PassContext& context, const gpu::ComputePipeline& count, std::span<const InjectCascade> cascades,
                 const VolumeImages& images, graph::BufferHandle occupied) {
    for (std::size_t i = cascades.size(); i-- > 0;) {
        const bool widest = i + 1 == cascades.size();
        const shading::VoxelGrid &grid = cascades[i].constants->grid, &outer = cascades[widest ? i : i + 1].constants->grid;
        const shading::EmptinessConstants constants{grid.base, grid.size, outer.base, cascades[i].constants->cascade, widest ? 1u : 0u};
        if (!widest) context.commands.compute_barrier();
        context.commands.dispatch_threads(count, constants, {context.buffer(occupied), context.buffer(images.occupancy)},
                                          {grid.size / 4, grid.size, grid.size});
    }
}

}  // namespace

VkDeviceSize occupancy_bytes(std::uint32_t size, std::uint32_t cascades) {
    return VkDeviceSize{sizeof(std::uint32_t)} * cascades * size * size * size;
}

Result<Occupied> add_occupied(graph::Graph& graph, gpu::Pipelines& pipelines, std::span<const InjectCascade> cascades,
                              const VolumeImages& images) {
    auto records = pipelines.compute("passes/occupancy/occupancy_records.comp");
    if (!records) return tl::unexpected(records.error());
    const std::uint32_t size = cascades.front().surfaces.size, count = static_cast<std::uint32_t>(cascades.size());
    const graph::BufferHandle occupied = graph.create_buffer(
        {"occupied faces", 4 * VkDeviceSize{shading::occupancy_first(size, count - 1, std::max(shading::occupancy_levels(size), 1u))}});
    graph.add_pass(
        "occupancy clear", graph::PassKind::transfer,
        [&](graph::PassBuilder& pass) { pass.write(occupied, Usage::transfer_write); },
        [occupied, outdated = cascades.front().outdated](graph::PassContext& context) {
            if (*outdated) context.commands.fill(context.buffer(occupied), 0);
        });
    const std::vector all(cascades.begin(), cascades.end());
    FinestWork work;
    work.uses = [all, occupied](graph::PassBuilder& pass) {
        for (const InjectCascade& cascade : all) {
            pass.read(cascade.surfaces.numbers, Usage::storage_read);
            pass.read(cascade.surfaces.numbers, Usage::indirect);
            pass.read(cascade.surfaces.cells, Usage::storage_read);
            pass.read(cascade.surfaces.records, Usage::storage_read);
        }
        pass.read_write(occupied, Usage::storage_read_write);
    };
    work.record = [all, images, occupied, records = *records](graph::PassContext& context) {
        if (*all.front().outdated) mark_voxels(context, *records, all, images, occupied);
    };
    return Occupied{occupied, std::move(work)};
}

Result<void> add_emptiness(graph::Graph& graph, gpu::Pipelines& pipelines, std::span<const InjectCascade> cascades,
                           const VolumeImages& images, graph::BufferHandle occupied) {
    auto levels = pipelines.compute("passes/occupancy/occupancy_levels.comp");
    if (!levels) return tl::unexpected(levels.error());
    auto empty = pipelines.compute("passes/occupancy/emptiness.comp");
    if (!empty) return tl::unexpected(empty.error());
    graph.add_pass(
        "occupancy", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(cascades.back().surfaces.levels, Usage::storage_read);
            pass.read(cascades.back().surfaces.levels, Usage::indirect);
            pass.read_write(images.faces, Usage::storage_read_write);  // it may have nothing to read: what wrote them stays to be waited for
            pass.read_write(occupied, Usage::storage_read_write);
        },
        [widest = cascades.back(), images, occupied, levels = *levels](graph::PassContext& context) {
            if (*widest.outdated) mark_levels(context, *levels, widest, images, occupied);
        });
    graph.add_pass(
        "occupancy levels", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(occupied, Usage::storage_read);
            pass.read_write(images.occupancy, Usage::storage_read_write);
        },
        [all = std::vector(cascades.begin(), cascades.end()), images, occupied, empty = *empty](graph::PassContext& context) {
            if (*all.front().outdated) count_empty(context, *empty, all, images, occupied);
        });
    return {};
}

}  // namespace heliodon::passes
