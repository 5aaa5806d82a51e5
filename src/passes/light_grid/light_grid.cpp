#include "passes/light_grid/light_grid.h"

#include <algorithm>

namespace heliodon::passes {
namespace {

// A grid is as fine as this many sums allow: 16 MiB.
constexpr std::uint64_t most_sums = 4ull << 20;
constexpr std::uint32_t finest_edge = 16;

}  // namespace

shading::LightGridHeader light_grid_header(const Bounds& scene, std::uint32_t light_first, std::uint32_t light_count) {
    shading::LightGridHeader header{};
    if (light_count <= shading::most_lights_summed || scene.empty()) return header;
    header.edge = finest_edge;
    while (header.edge > 1 && std::uint64_t{header.edge} * header.edge * header.edge * light_count > most_sums) header.edge /= 2;
    header.origin = scene.min;
    // Flat scenes have cells with a volume, too.
    const glm::vec3 extent = glm::max(scene.extent(), glm::vec3(std::max(1e-3f * scene.diagonal(), 1e-6f)));
    header.cell_m = extent / static_cast<float>(header.edge);
    header.light_first = light_first;
    header.light_count = light_count;
    return header;
}

VkDeviceSize light_grid_bytes(const shading::LightGridHeader& header) {
    return sizeof(header) + sizeof(std::uint32_t) * header.edge * header.edge * header.edge * VkDeviceSize{header.light_count};
}

Result<void> record_light_grid(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                               const gpu::Buffer& grid, const shading::LightGridHeader& header) {
    auto pipeline = pipelines.compute("passes/light_grid/light_grid.comp");
    if (!pipeline) return tl::unexpected(pipeline.error());
    const gpu::Access before{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
    const gpu::Access written{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
    const gpu::Access read{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
    commands.memory_barrier(before, written);
    commands.dispatch_threads(**pipeline, gpu::NoPushConstants{}, select_bindings(**pipeline, scene, {{24, grid}}),
                              {header.edge * header.edge * header.edge, 1, 1});
    commands.memory_barrier(written, read);
    return {};
}

}  // namespace heliodon::passes
