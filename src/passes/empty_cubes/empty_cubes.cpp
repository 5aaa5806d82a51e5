#include "passes/empty_cubes/empty_cubes.h"

#include <algorithm>

#include "passes/empty_cubes/empty_cubes_shared.h"

namespace heliodon::passes {

std::uint32_t empty_cube_words(std::uint32_t size) {
    const std::uint32_t cells = std::max(1u, size >> shading::cube_cell_level);
    return cells * cells * cells;
}

Result<void> add_empty_cubes(graph::Graph& graph, gpu::Pipelines& pipelines, const VolumeImages& images, std::uint32_t size,
                             std::uint32_t cascades, const bool& outdated) {
    auto pipeline = pipelines.compute("passes/empty_cubes/empty_cubes.comp");
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "empty cubes", graph::PassKind::compute,
        [&](graph::PassBuilder& pass) {
            pass.read(images.faces, graph::Usage::storage_read);
            pass.read_write(images.cubes, graph::Usage::storage_read_write);
        },
        [images, size, cascades, &outdated, grow = *pipeline](graph::PassContext& context) {
            if (!outdated) return;
            const gpu::Image& level = context.image(images.faces);
            const std::uint32_t cells = size >> shading::cube_cell_level;
            for (std::uint32_t step = 1; step <= shading::largest_cube_step && shading::cube_edge(step) <= cells; ++step) {
                if (step > 1) context.commands.compute_barrier();
                const shading::EmptyCubesConstants constants{cells, (cascades - 1) * cells, step, 0};
                context.commands.dispatch_threads(*grow, constants, {level.mip(shading::cube_cell_level), context.buffer(images.cubes)},
                                                  {cells, cells, cells});
            }
        });
    return {};
}

}  // namespace heliodon::passes
