#include "passes/shadow_volumes/lit_map.h"

#include <algorithm>

#include "passes/visibility/visibility.h"
#include "passes/voxelize/voxel_shared.h"

namespace heliodon::passes {
namespace {

using graph::PassBuilder;
using graph::PassContext;
using graph::Usage;

// Each step a silhouette gives way by a row of triangles at most; what is left then is seldom shortened by more.
constexpr int join_steps = 16;

/// Workgroups of 64 spread over rows as linear_groups.glsl counts them.
glm::uvec3 groups_for(std::uint32_t threads) {
    const std::uint32_t groups = threads / 64 + (threads % 64 ? 1 : 0);
    return {std::min(groups, shading::groups_a_row), (groups + shading::groups_a_row - 1) / shading::groups_a_row, 1};
}

}  // namespace

Result<void> record_classify(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                             const Casters& casters, glm::vec3 sun, float significant_m2) {
    auto classify = pipelines.compute("passes/shadow_volumes/classify.comp");
    if (!classify) return tl::unexpected(classify.error());
    const shading::ClassifyConstants push{sun, significant_m2, casters.range_count, casters.triangle_count};
    commands.dispatch(**classify, push,
                      select_bindings(**classify, scene, {{12, *casters.ranges}, {13, *casters.states}}),
                      groups_for(casters.triangle_count));
    return {};
}

Result<void> add_lit_map(graph::Graph& graph, gpu::Pipelines& pipelines, SceneInputs& scene, const Casters& casters,
                         const LitMapBuffers& buffers, const gpu::Buffer& view, const shading::LitMapConstants& part,
                         std::uint32_t size, std::uint32_t instance_capacity) {
    static constexpr std::uint32_t one_view = 1;
    auto lists = add_cull(graph, pipelines, scene, {1, instance_capacity, false}, view, one_view);
    if (!lists) return tl::unexpected(lists.error());
    auto map = add_visibility(graph, pipelines, scene, view, *lists, {size, size});
    if (!map) return tl::unexpected(map.error());
    auto mark = pipelines.compute("passes/shadow_volumes/mark.comp");
    if (!mark) return tl::unexpected(mark.error());
    auto settle = pipelines.compute("passes/shadow_volumes/settle.comp");
    if (!settle) return tl::unexpected(settle.error());
    auto nearest = pipelines.device().sampler(gpu::SamplerDescription::nearest_clamp());
    if (!nearest) return tl::unexpected(nearest.error());
    const auto declare = [&](PassBuilder& pass, graph::ImageHandle image) {
        pass.read(image, Usage::sampled);
        pass.read_write(buffers.states, Usage::storage_read_write);
        pass.read_write(buffers.header, Usage::storage_read_write);
    };
    graph.add_pass(
        "mark lit triangles", graph::PassKind::compute, [&](PassBuilder& pass) { declare(pass, map->ids); },
        [&scene, &casters, &part, map = *map, buffers, size, mark = *mark, nearest = *nearest](PassContext& context) {
            const auto bindings = select_bindings(*mark, scene,
                                                  {{8, gpu::Binding(context.image(map.ids), nearest)},
                                                   {9, *casters.first_triangles},
                                                   {13, context.buffer(buffers.states)},
                                                   {14, context.buffer(buffers.header)}});
            context.commands.dispatch_threads(*mark, part, bindings, {size, size, 1});
        });
    graph.add_pass(
        "settle small triangles", graph::PassKind::compute, [&](PassBuilder& pass) { declare(pass, map->depth); },
        [&scene, &casters, &part, map = *map, buffers, settle = *settle, nearest = *nearest](PassContext& context) {
            const auto bindings = select_bindings(*settle, scene,
                                                  {{8, gpu::Binding(context.image(map.depth), nearest)},
                                                   {12, *casters.ranges},
                                                   {13, context.buffer(buffers.states)},
                                                   {14, context.buffer(buffers.header)}});
            context.commands.dispatch(*settle, part, bindings, groups_for(casters.triangle_count));
        });
    return {};
}

Result<void> record_joins(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                          const Casters& casters, const gpu::Buffer& weights, const gpu::Buffer& tallies) {
    auto weigh = pipelines.compute("passes/shadow_volumes/weigh_joins.comp");
    if (!weigh) return tl::unexpected(weigh.error());
    auto join = pipelines.compute("passes/shadow_volumes/join.comp");
    if (!join) return tl::unexpected(join.error());
    auto tally = pipelines.compute("passes/shadow_volumes/tally.comp");
    if (!tally) return tl::unexpected(tally.error());
    const shading::SilhouetteConstants edges{casters.range_count, casters.edge_count, 0, 0};
    const shading::SilhouetteConstants triangles{casters.range_count, casters.triangle_count, 0, 0};
    const std::initializer_list<NumberedBinding> bound{{9, *casters.edges},   {10, *casters.edge_uses},
                                                       {12, *casters.ranges}, {13, *casters.states},
                                                       {15, weights},         {16, tallies}};
    for (int step = 0; step < join_steps; ++step) {
        commands.dispatch(**weigh, edges, select_bindings(**weigh, scene, bound), groups_for(casters.edge_count));
        commands.compute_barrier();
        commands.dispatch(**join, triangles, select_bindings(**join, scene, bound), groups_for(casters.triangle_count));
        commands.compute_barrier();
    }
    commands.dispatch(**tally, edges, select_bindings(**tally, scene, bound), groups_for(casters.edge_count));
    return {};
}

Result<void> record_volume_lists(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                 const Casters& casters, const VolumeLists& lists, std::uint32_t choice) {
    auto silhouettes = pipelines.compute("passes/shadow_volumes/silhouettes.comp");
    if (!silhouettes) return tl::unexpected(silhouettes.error());
    auto caps = pipelines.compute("passes/shadow_volumes/caps.comp");
    if (!caps) return tl::unexpected(caps.error());
    const shading::SilhouetteConstants edges{casters.range_count, casters.edge_count, lists.side_capacity, choice};
    commands.dispatch(**silhouettes, edges,
                      select_bindings(**silhouettes, scene,
                                      {{9, *casters.edges},
                                       {10, *casters.edge_uses},
                                       {12, *casters.ranges},
                                       {13, *casters.states},
                                       {14, *lists.draws},
                                       {15, *lists.sides},
                                       {16, *lists.tallies}}),
                      groups_for(casters.edge_count));
    const shading::SilhouetteConstants triangles{casters.range_count, casters.triangle_count, lists.cap_capacity,
                                                 choice};
    commands.dispatch(**caps, triangles,
                      select_bindings(**caps, scene,
                                      {{12, *casters.ranges},
                                       {13, *casters.states},
                                       {14, *lists.draws},
                                       {15, *lists.caps},
                                       {16, *lists.tallies}}),
                      groups_for(casters.triangle_count));
    return {};
}

}  // namespace heliodon::passes
