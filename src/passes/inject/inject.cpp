#include "passes/inject/inject.h"

#include "passes/shadow_cones/shadow_cones.h"

#include <bit>
#include <cstddef>

namespace heliodon::passes {
namespace {

using graph::PassBuilder;
using graph::PassContext;
using graph::PassKind;
using graph::Usage;

constexpr VkDeviceSize record_groups = offsetof(shading::VoxelHeader, record_groups);
constexpr VkDeviceSize lit_groups = offsetof(shading::LitFacesHeader, groups);
constexpr VkDeviceSize lit_gather_groups = offsetof(shading::LitFacesHeader, gather_groups);
constexpr std::uint32_t every_side = (1u << shading::voxel_faces) - 1;

VkDeviceSize level_groups(std::uint32_t level) { return level * sizeof(glm::uvec4); }
gpu::Specialization lobes_constant(const InjectCascade& cascade) { return {{22, cascade.lobes ? 1u : 0u}}; }
/// Where there are none, something that nothing reads.
graph::BufferHandle lobes_or_none(const InjectCascade& cascade) { return cascade.lobes ? cascade.lobes : cascade.exitance; }
std::uint32_t level_count(std::uint32_t size) { return static_cast<std::uint32_t>(std::bit_width(size)); }

shading::FilterConstants level_constants(const InjectCascade& cascade, std::uint32_t level) {
    const VoxelSurfaces& surfaces = cascade.surfaces;
    return {level, surfaces.size, cascade.constants->cascade,
            shading::voxel_level_first(level, surfaces.size, surfaces.record_capacity)};
}

/// One dispatch a side over its list of faces, of the sides in `sides` (a bit each).
void dispatch_lit_faces(PassContext& context, const gpu::ComputePipeline& pipeline, const InjectCascade& cascade,
                        const std::vector<gpu::Binding>& bindings, VkDeviceSize groups, std::uint32_t sides, bool unlit_only = false) {
    shading::InjectConstants constants = *cascade.constants;
    constants.unlit_only = unlit_only ? 1 : 0;
    for (constants.face = 0; constants.face < shading::voxel_faces; ++constants.face)
        if ((sides >> constants.face & 1u) != 0)
            context.commands.dispatch_indirect(pipeline, constants, bindings, context.buffer(cascade.lit_faces),
                                               groups + constants.face * sizeof(glm::uvec4));
}

}  // namespace

VkDeviceSize lit_faces_bytes(std::uint32_t record_capacity) {
    return sizeof(shading::LitFacesHeader) + VkDeviceSize{record_capacity} * shading::voxel_faces * sizeof(std::uint32_t);
}

Result<void> add_list_faces(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade) {
    auto pipeline = pipelines.compute("passes/inject/list_faces.comp", lobes_constant(cascade));
    if (!pipeline) return tl::unexpected(pipeline.error());
    auto find_kept = pipelines.compute("passes/inject/find_kept.comp");
    if (!find_kept) return tl::unexpected(find_kept.error());
    const graph::BufferHandle sources =
        graph.create_buffer({"sources of gathered light", VkDeviceSize{cascade.surfaces.record_capacity} * sizeof(std::uint32_t)});
    graph.add_pass(
        "voxelize list clear", PassKind::transfer,
        [&](PassBuilder& pass) {
            pass.write(cascade.lit_faces, Usage::transfer_write);
            pass.write(sources, Usage::transfer_write);
        },
        [lit_faces = cascade.lit_faces, sources](PassContext& context) {
            context.commands.fill(context.buffer(lit_faces), 0, 0, sizeof(shading::LitFacesHeader));
            context.commands.fill(context.buffer(sources), 0);
        });
    graph.add_pass(
        "voxelize find kept", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read(cascade.shown.numbers, Usage::storage_read);
            pass.read(cascade.shown.numbers, Usage::indirect);
            pass.read(cascade.shown.cells, Usage::storage_read);
            pass.read(cascade.surfaces.numbers, Usage::storage_read);
            pass.read_write(sources, Usage::storage_read_write);
        },
        [cascade, sources, find = *find_kept](PassContext& context) {
            if (!*cascade.keeps_light) return;
            const gpu::Buffer& kept = context.buffer(cascade.shown.numbers);
            context.commands.dispatch_indirect(*find, *cascade.constants,
                                               {kept, context.buffer(cascade.shown.cells), context.buffer(cascade.surfaces.numbers),
                                                context.buffer(sources)},
                                               kept, record_groups);
        });
    graph.add_pass(
        "voxelize list", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read(cascade.surfaces.numbers, Usage::storage_read);
            pass.read(cascade.surfaces.numbers, Usage::indirect);
            pass.read(cascade.surfaces.cells, Usage::storage_read);
            pass.read(cascade.surfaces.records, Usage::storage_read);
            pass.read(cascade.shown.gathered, Usage::storage_read);
            pass.read(sources, Usage::storage_read);
            pass.read_write(cascade.exitance, Usage::storage_read_write);
            if (cascade.lobes) pass.read_write(cascade.lobes, Usage::storage_read_write);
            pass.read_write(cascade.gathered, Usage::storage_read_write);
            pass.read_write(cascade.lit_faces, Usage::storage_read_write);
        },
        [cascade, sources, list = *pipeline](PassContext& context) {
            const gpu::Buffer& numbers = context.buffer(cascade.surfaces.numbers);
            context.commands.dispatch_indirect(*list, *cascade.constants,
                                               {numbers, context.buffer(cascade.surfaces.cells),
                                                context.buffer(cascade.surfaces.records), context.buffer(cascade.exitance),
                                                context.buffer(cascade.shown.gathered), context.buffer(sources),
                                                context.buffer(cascade.gathered), context.buffer(cascade.lit_faces),
                                                context.buffer(lobes_or_none(cascade))},
                                               numbers, record_groups);
        });
    return {};
}

void add_keep_shown(graph::Graph& graph, const InjectCascade& cascade) {
    graph.add_pass(
        "voxelize keep", PassKind::transfer,
        [&](PassBuilder& pass) {
            pass.read(cascade.surfaces.numbers, Usage::transfer_read);
            pass.read(cascade.surfaces.cells, Usage::transfer_read);
            pass.read(cascade.surfaces.levels, Usage::transfer_read);
            pass.read(cascade.gathered, Usage::transfer_read);
            pass.write(cascade.shown.gathered, Usage::transfer_write);
            pass.write(cascade.shown.numbers, Usage::transfer_write);
            pass.write(cascade.shown.cells, Usage::transfer_write);
            pass.write(cascade.shown.levels, Usage::transfer_write);
        },
        [cascade](PassContext& context) {
            if (*cascade.outdated) return;
            const auto keep = [&](graph::BufferHandle from, graph::BufferHandle to) {
                context.commands.copy(context.buffer(from), context.buffer(to), context.buffer(to).size());
            };
            keep(cascade.surfaces.numbers, cascade.shown.numbers);
            if (*cascade.swapped) return;
            keep(cascade.surfaces.cells, cascade.shown.cells);
            keep(cascade.surfaces.levels, cascade.shown.levels);
            if (*cascade.keeps_light) keep(cascade.gathered, cascade.shown.gathered);
        });
}

Result<void> add_volume_clear(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade,
                              const VolumeImages& images, bool levels) {
    auto clear_records = pipelines.compute("passes/inject/clear_records.comp");
    if (!clear_records) return tl::unexpected(clear_records.error());
    auto clear_levels = pipelines.compute("passes/inject/clear_levels.comp");
    if (!clear_levels) return tl::unexpected(clear_levels.error());
    auto clear_lobes = pipelines.compute("passes/inject/clear_lobes.comp");
    if (!clear_lobes) return tl::unexpected(clear_lobes.error());
    graph.add_pass(
        "voxelize empty", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read(cascade.shown.numbers, Usage::storage_read);
            pass.read(cascade.shown.numbers, Usage::indirect);
            pass.read(cascade.shown.cells, Usage::storage_read);
            pass.read(cascade.surfaces.records, Usage::storage_read);
            pass.read(cascade.shown.levels, Usage::storage_read);
            pass.read(cascade.shown.levels, Usage::indirect);
            pass.write(images.faces, Usage::storage_write);
            pass.write(images.depths, Usage::storage_write);
            if (cascade.lobes) pass.write(images.lobes, Usage::storage_write);
        },
        [cascade, images, levels, clear_records = *clear_records, clear_levels = *clear_levels, clear_lobes = *clear_lobes](PassContext& context) {
            if (!*cascade.outdated) return;
            const VoxelSurfaces& surfaces = cascade.surfaces;
            const gpu::Buffer& numbers = context.buffer(cascade.shown.numbers);
            const gpu::Image &faces = context.image(images.faces), &depths = context.image(images.depths);
            context.commands.dispatch_indirect(
                *clear_records, *cascade.constants,
                {numbers, context.buffer(cascade.shown.cells), context.buffer(surfaces.records), faces.mip(0),
                 depths.mip(0)}, numbers, record_groups);
            const gpu::Buffer& lists = context.buffer(cascade.shown.levels);
            for (std::uint32_t level = 1; levels && level < level_count(surfaces.size); ++level)
                context.commands.dispatch_indirect(*clear_levels, level_constants(cascade, level), {lists, faces.mip(level), depths.mip(level)},
                                                   lists, level_groups(level));
            for (std::uint32_t level = 1; cascade.lobes && level < (levels ? level_count(surfaces.size) : 2); ++level)
                context.commands.dispatch_indirect(*clear_lobes, level_constants(cascade, level), {lists, context.image(images.lobes).mip(level - 1)},
                                                   lists, level_groups(level));
        });
    return {};
}

Result<void> add_direct_light(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                              const LightingInputs& lighting, const InjectCascade& cascade, const ShadowMaps& shadow_maps,
                              const VolumeImages& images, graph::BufferHandle shares) {
    gpu::Specialization constants = cone_constants(*lighting.volume, lighting.cone_shadows);
    set_light_constants(constants, scene);
    constants[17] = lighting.shadows_traced ? 1 : 0;
    if (lighting.shadows_traced && !shares) {
        auto traced = voxel_shadows(graph, pipelines, scene, lighting, cascade, images);
        if (!traced) return tl::unexpected(traced.error());
        graph.add_pass("inject shadow cones", PassKind::compute, traced->uses, traced->record);
        shares = traced->shares;
    }
    auto pipeline = pipelines.compute("passes/inject/direct.comp", constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "inject lights", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read(cascade.surfaces.numbers, Usage::storage_read);
            pass.read(cascade.lit_faces, Usage::storage_read);
            pass.read(cascade.lit_faces, Usage::indirect);
            pass.read(cascade.surfaces.cells, Usage::storage_read);
            pass.read(cascade.surfaces.records, Usage::storage_read);
            pass.read(shadow_maps.depth, Usage::sampled);
            pass.read(shadow_maps.slope, Usage::sampled);
            if (shares) pass.read(shares, Usage::storage_read);  // of the volume's shadows, which it then need not find
            else read_volume(pass, images);
            pass.read_write(cascade.exitance, Usage::storage_read_write);
            if (cascade.lobes) pass.read_write(cascade.lobes, Usage::storage_read_write);
        },
        [&scene, &lighting, cascade, shadow_maps, shares, direct = *pipeline](PassContext& context) {
            const auto bindings = select_bindings(*direct, scene, with_volume(*lighting.volume,
                                                  {{9, *lighting.shadow_views},
                                                   {24, *lighting.light_grid},
                                                   {10, gpu::Binding(context.image(shadow_maps.depth), lighting.nearest)},
                                                   {15, gpu::Binding(context.image(shadow_maps.slope), lighting.nearest)},
                                                   {16, context.buffer(cascade.surfaces.numbers)},
                                                   {17, context.buffer(cascade.surfaces.cells)},
                                                   {25, context.buffer(cascade.lit_faces)},
                                                   {18, context.buffer(cascade.surfaces.records)},
                                                   {19, context.buffer(cascade.exitance)},
                                                   {28, context.buffer(lobes_or_none(cascade))},
                                                   {11, *lighting.shading_tables},
                                                   {27, context.buffer(shares ? shares : cascade.surfaces.cells)}}));  // else nothing reads it
            dispatch_lit_faces(context, *direct, cascade, bindings, lit_groups, every_side);
        });
    return {};
}

Result<void> add_gather(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene, const VolumeInputs& volume,
                        const InjectCascade& cascade, const VolumeImages& images, const VoxelShadows* beside) {
    auto pipeline = pipelines.compute("passes/inject/gather.comp", cone_constants(volume));
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "gather", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read(cascade.surfaces.numbers, Usage::storage_read);
            pass.read(cascade.lit_faces, Usage::storage_read);
            pass.read(cascade.lit_faces, Usage::indirect);
            pass.read(cascade.surfaces.cells, Usage::storage_read);
            pass.read(cascade.surfaces.records, Usage::storage_read);
            read_volume(pass, images);
            pass.read_write(cascade.gathered, Usage::storage_read_write);
            if (beside) beside->uses(pass);
        },
        [&scene, &volume, cascade, images, gather = *pipeline,
         record_beside = beside ? beside->record : nullptr](PassContext& context) {
            if (record_beside) record_beside(context);
            const auto bindings = select_bindings(*gather, scene, with_volume(volume,
                                                  {{16, context.buffer(cascade.surfaces.numbers)},
                                                   {17, context.buffer(cascade.surfaces.cells)},
                                                   {25, context.buffer(cascade.lit_faces)},
                                                   {18, context.buffer(cascade.surfaces.records)},
                                                   {19, context.buffer(cascade.gathered)}}));
            dispatch_lit_faces(context, *gather, cascade, bindings, lit_gather_groups, cascade.gather_faces->all);
            dispatch_lit_faces(context, *gather, cascade, bindings, lit_gather_groups, cascade.gather_faces->unlit, true);
        });
    return {};
}

Result<void> add_radiance(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade,
                          const VolumeImages& images, bool emission_only) {
    auto pipeline = pipelines.compute("passes/inject/radiance.comp", {{0, emission_only ? 1u : 0u}, {1, cascade.isotropic ? 1u : 0u}});
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "radiance", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read(cascade.surfaces.numbers, Usage::storage_read);
            pass.read(cascade.surfaces.numbers, Usage::indirect);
            pass.read(cascade.surfaces.cells, Usage::storage_read);
            pass.read(cascade.surfaces.records, Usage::storage_read);
            pass.read(cascade.exitance, Usage::storage_read);
            pass.read(cascade.gathered, Usage::storage_read);
            pass.write(images.faces, Usage::storage_write);
            pass.write(images.depths, Usage::storage_write);
        },
        [cascade, images, radiance = *pipeline](PassContext& context) {
            const gpu::Buffer& numbers = context.buffer(cascade.surfaces.numbers);
            context.commands.dispatch_indirect(*radiance, *cascade.constants,
                                               {numbers, context.buffer(cascade.surfaces.cells),
                                                context.buffer(cascade.surfaces.records), context.buffer(cascade.exitance),
                                                context.image(images.faces).mip(0), context.image(images.depths).mip(0),
                                                context.buffer(cascade.gathered)},
                                               numbers, record_groups);
        });
    return {};
}

void read_lobe_records(PassBuilder& pass, const InjectCascade& cascade) {
    pass.read(cascade.surfaces.numbers, Usage::storage_read);
    pass.read(cascade.surfaces.records, Usage::storage_read);
    pass.read(cascade.lobes, Usage::storage_read);
}

/// A level of what faces send ahead, level 1 from the records, the others from the level before.
void record_lobes(PassContext& context, const gpu::ComputePipeline& pipeline, const InjectCascade& cascade, const VolumeImages& images,
                  std::uint32_t level) {
    const gpu::Buffer& lists = context.buffer(cascade.surfaces.levels);
    const gpu::Image& lobes = context.image(images.lobes);
    context.commands.dispatch_indirect(pipeline, level_constants(cascade, level),
                                       {lists, context.buffer(cascade.surfaces.records), context.buffer(cascade.surfaces.numbers),
                                        lobes.mip(level > 1 ? level - 2 : 0), lobes.mip(level - 1), context.buffer(cascade.lobes)},
                                       lists, level_groups(level));
}

Result<void> add_lobes(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade, const VolumeImages& images,
                       bool emission_only) {
    if (!cascade.lobes) return {};
    auto pipeline = pipelines.compute("passes/inject/lobes.comp", {{0, emission_only ? 1u : 0u}, {1, 1}});
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        "lobes", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read(cascade.surfaces.levels, Usage::storage_read);
            pass.read(cascade.surfaces.levels, Usage::indirect);
            read_lobe_records(pass, cascade);
            pass.read_write(images.lobes, Usage::storage_read_write);
        },
        [cascade, images, lobes = *pipeline](PassContext& context) { record_lobes(context, *lobes, cascade, images, 1); });
    return {};
}

Result<void> add_filter(graph::Graph& graph, gpu::Pipelines& pipelines, const InjectCascade& cascade, const VolumeImages& images,
                        const FinestWork& beside) {
    auto pipeline = pipelines.compute("passes/inject/filter.comp", {{0, cascade.isotropic ? 1u : 0u}});
    if (!pipeline) return tl::unexpected(pipeline.error());
    auto filter_lobes = pipelines.compute("passes/inject/lobes.comp", {{0, 0}, {1, 0}});
    if (!filter_lobes) return tl::unexpected(filter_lobes.error());
    graph.add_pass(
        "filter", PassKind::compute,
        [&](PassBuilder& pass) {
            pass.read(cascade.surfaces.levels, Usage::storage_read);
            pass.read(cascade.surfaces.levels, Usage::indirect);
            pass.read_write(images.faces, Usage::storage_read_write);
            pass.read_write(images.depths, Usage::storage_read_write);
            if (cascade.lobes) {
                read_lobe_records(pass, cascade);
                pass.read_write(images.lobes, Usage::storage_read_write);
            }
            beside.uses(pass);
        },
        [cascade, images, beside = beside.record, filter = *pipeline, filter_lobes = *filter_lobes](PassContext& context) {
            const gpu::Buffer& lists = context.buffer(cascade.surfaces.levels);
            const gpu::Image &faces = context.image(images.faces), &depths = context.image(images.depths);
            beside(context);
            for (std::uint32_t level = 1; level < level_count(cascade.surfaces.size); ++level) {
                if (level > 1) context.commands.compute_barrier();
                context.commands.dispatch_indirect(*filter, level_constants(cascade, level),
                                                   {lists, faces.mip(level - 1), faces.mip(level), depths.mip(level - 1), depths.mip(level)}, lists, level_groups(level));
                if (cascade.lobes && level > 1) record_lobes(context, *filter_lobes, cascade, images, level);
            }
        });
    return {};
}

}  // namespace heliodon::passes
