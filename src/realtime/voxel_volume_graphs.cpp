// The frame graphs of the volume's steps.
#include "realtime/voxel_volume.h"

#include "passes/occupancy/occupancy.h"
#include "passes/shadow_cones/shadow_cones.h"

namespace heliodon::realtime {
namespace {

/// Copies surfaces to where they are carried from.
void add_keep_still(graph::Graph& graph, const passes::VoxelSurfaces& surfaces, const passes::CarriedSurfaces& still) {
    graph.add_pass(
        "voxelize keep", graph::PassKind::transfer,
        [&](graph::PassBuilder& pass) {
            for (const graph::BufferHandle from : {surfaces.numbers, surfaces.cells, surfaces.records}) pass.read(from, graph::Usage::transfer_read);
            for (const graph::BufferHandle to : {still.numbers, still.cells, still.records}) pass.write(to, graph::Usage::transfer_write);
        },
        [surfaces, still](graph::PassContext& context) {
            const auto copy = [&](graph::BufferHandle from, graph::BufferHandle to) {
                context.commands.copy(context.buffer(from), context.buffer(to), context.buffer(to).size());
            };
            copy(surfaces.numbers, still.numbers);
            copy(surfaces.cells, still.cells);
            copy(surfaces.records, still.records);
        });
}

}  // namespace

/// A graph in which the volume's resources are known; every graph imports them in the same order.
struct VoxelVolume::VolumeGraph {
    graph::Graph graph;
    passes::VolumeImages images;
    passes::ShadowMaps shadow_maps;
    std::vector<passes::InjectCascade> cascades;
    std::vector<passes::CarriedSurfaces> still;  ///< of each cascade, if they are kept
};

VoxelVolume::VolumeGraph VoxelVolume::begin_graph(const Source& source) const {
    VolumeGraph volume;
    volume.images = {volume.graph.import_image(faces_.description()), volume.graph.import_image(depths_.description()),
                     volume.graph.import_image(lobes_.description()),
                     volume.graph.import_buffer(occupancy_.description())};
    volume.shadow_maps = {volume.graph.import_image(source.shadow_depth.description()),
                          volume.graph.import_image(source.shadow_slope.description())};
    for (const auto& cascade : cascades_) {
        const auto import = [&](const gpu::Buffer& buffer) { return volume.graph.import_buffer(buffer.description()); };
        passes::InjectCascade one;
        one.constants = &cascade->constants;
        one.outdated = &outdated_;
        one.keeps_light = &keeps_light_;
        one.swapped = &swapped_;
        one.shown = {import(cascade->shown_numbers), import(cascade->shown_cells), import(cascade->shown_levels),
                     import(cascade->shown_gathered)};
        one.surfaces = {import(cascade->numbers), import(cascade->cells), import(cascade->records), import(cascade->tiles),
                        import(cascade->levels), data_.size, record_capacity_, tile_capacity_};
        one.lit_faces = import(cascade->lit_faces);
        one.gather_faces = &cascade->gather_faces;
        one.exitance = import(cascade->exitance);
        if (cascade->lobes) one.lobes = import(cascade->lobes);
        one.gathered = import(cascade->gathered);
        one.isotropic = settings_.isotropic;
        volume.cascades.push_back(one);
        if (cascade->still_records)
            volume.still.push_back({import(cascade->still_numbers), import(cascade->still_cells), import(cascade->still_records)});
    }
    return volume;
}

Result<void> VoxelVolume::finish_graph(graph::Executor& executor, VolumeGraph& volume, const Source& source) const {
    volume.graph.export_image(volume.images.faces, graph::Usage::sampled);
    volume.graph.export_image(volume.images.depths, graph::Usage::sampled);
    volume.graph.export_image(volume.images.lobes, graph::Usage::sampled);
    volume.graph.export_buffer(volume.images.occupancy);
    for (const auto& one : volume.cascades) {
        if (one.lobes) volume.graph.export_buffer(one.lobes);
        for (const graph::BufferHandle buffer : {one.surfaces.numbers, one.surfaces.cells, one.surfaces.records,
                                                 one.surfaces.tiles, one.surfaces.levels, one.lit_faces, one.exitance, one.gathered,
                                                 one.shown.numbers, one.shown.cells, one.shown.levels, one.shown.gathered})
            volume.graph.export_buffer(buffer);
    }
    for (const passes::CarriedSurfaces& still : volume.still)
        for (const graph::BufferHandle buffer : {still.numbers, still.cells, still.records}) volume.graph.export_buffer(buffer);
    if (auto done = executor.set_graph(volume.graph); !done) return done;
    executor.bind(volume.images.faces, faces_);
    executor.bind(volume.images.depths, depths_);
    executor.bind(volume.images.lobes, lobes_);
    executor.bind(volume.images.occupancy, occupancy_);
    executor.bind(volume.shadow_maps.depth, source.shadow_depth);
    executor.bind(volume.shadow_maps.slope, source.shadow_slope);
    for (std::size_t i = 0; i < cascades_.size(); ++i) {
        const Cascade& cascade = *cascades_[i];
        const passes::InjectCascade& one = volume.cascades[i];
        executor.bind(one.surfaces.numbers, cascade.numbers);
        executor.bind(one.surfaces.cells, cascade.cells);
        executor.bind(one.surfaces.records, cascade.records);
        executor.bind(one.surfaces.tiles, cascade.tiles);
        executor.bind(one.surfaces.levels, cascade.levels);
        executor.bind(one.shown.numbers, cascade.shown_numbers);
        executor.bind(one.shown.cells, cascade.shown_cells);
        executor.bind(one.shown.levels, cascade.shown_levels);
        executor.bind(one.shown.gathered, cascade.shown_gathered);
        executor.bind(one.lit_faces, cascade.lit_faces);
        executor.bind(one.exitance, cascade.exitance);
        if (one.lobes) executor.bind(one.lobes, cascade.lobes);
        executor.bind(one.gathered, cascade.gathered);
        if (volume.still.empty()) continue;
        executor.bind(volume.still[i].numbers, cascade.still_numbers);
        executor.bind(volume.still[i].cells, cascade.still_cells);
        executor.bind(volume.still[i].records, cascade.still_records);
    }
    return {};
}

Result<void> VoxelVolume::build_surface_graphs(const Source& source) {
    const auto voxelize = settings_.raster ? passes::add_voxelize_raster : passes::add_voxelize;
    VolumeGraph shown = begin_graph(source);
    for (const auto& cascade : shown.cascades) passes::add_keep_shown(shown.graph, cascade);
    if (auto done = finish_graph(steps_->keep_shown, shown, source); !done) return done;

    steps_->surfaces.clear();
    for (std::size_t i = 0; i < cascades_.size(); ++i) {
        SurfaceSteps& steps = *steps_->surfaces.emplace_back(std::make_unique<SurfaceSteps>(device_));
        const auto build = [&](graph::Executor& executor, const passes::VoxelizeInputs& inputs, bool carry) -> Result<void> {
            VolumeGraph volume = begin_graph(source);
            passes::VoxelSurfaces surfaces = volume.cascades[i].surfaces;
            if (carry) surfaces.carried = volume.still[i];
            if (auto done = voxelize(volume.graph, pipelines_, source.inputs, inputs, surfaces); !done) return done;
            return finish_graph(executor, volume, source);
        };
        if (auto done = build(steps.all, cascades_[i]->still, false); !done) return done;
        VolumeGraph list = begin_graph(source);
        if (auto done = passes::add_list_faces(list.graph, pipelines_, list.cascades[i]); !done) return done;
        if (auto done = finish_graph(steps.list, list, source); !done) return done;
        if (!cascades_[i]->still_records) continue;
        VolumeGraph keep = begin_graph(source);
        add_keep_still(keep.graph, keep.cascades[i].surfaces, keep.still[i]);
        if (auto done = finish_graph(steps.keep, keep, source); !done) return done;
        if (auto done = build(steps.enter, cascades_[i]->entered, true); !done) return done;
        if (auto done = build(steps.move, cascades_[i]->moving, true); !done) return done;
    }
    return {};
}

Result<void> VoxelVolume::build_lit_bounce(const Source& source, const std::function<Result<void>(VolumeGraph&, bool)>& add_volume) {
    if (!source.lighting.shadows_traced) return {};
    VolumeGraph lit = begin_graph(source);
    for (const auto& cascade : lit.cascades) {
        const auto shadows = passes::voxel_shadows(lit.graph, pipelines_, source.inputs, source.lighting, cascade, lit.images);
        if (!shadows) return tl::unexpected(shadows.error());
        if (auto done = passes::add_gather(lit.graph, pipelines_, source.inputs, shown_inputs_, cascade, lit.images, &*shadows); !done)
            return done;
        if (auto done = passes::add_direct_light(lit.graph, pipelines_, source.inputs, source.lighting, cascade, lit.shadow_maps,
                                                 lit.images, shadows->shares); !done)
            return done;
    }
    if (auto done = add_volume(lit, false); !done) return done;
    return finish_graph(steps_->lit_bounce, lit, source);
}

Result<void> VoxelVolume::build_graphs(const Source& source) {
    if (auto done = build_surface_graphs(source); !done) return done;
    const auto begin = [&] { return begin_graph(source); };
    const auto finish = [&](graph::Executor& executor, VolumeGraph& volume) { return finish_graph(executor, volume, source); };
    const std::size_t last = cascades_.size() - 1;

    VolumeGraph lights = begin();
    for (const auto& cascade : lights.cascades)
        if (auto done = passes::add_direct_light(lights.graph, pipelines_, source.inputs, source.lighting, cascade, lights.shadow_maps,
                                                 lights.images); !done)
            return done;
    if (auto done = finish(steps_->lights, lights); !done) return done;

    const auto add_volume = [&](VolumeGraph& volume, bool emission_only) -> Result<void> {
        const auto occupied = passes::add_occupied(volume.graph, pipelines_, volume.cascades, volume.images);
        if (!occupied) return tl::unexpected(occupied.error());
        for (std::size_t i = 0; i <= last; ++i)
            if (auto done = passes::add_volume_clear(volume.graph, pipelines_, volume.cascades[i], volume.images, i == last); !done)
                return done;
        for (const auto& cascade : volume.cascades)
            if (auto done = passes::add_radiance(volume.graph, pipelines_, cascade, volume.images, emission_only); !done) return done;
        for (const auto& cascade : volume.cascades)
            if (auto done = passes::add_lobes(volume.graph, pipelines_, cascade, volume.images, emission_only); !done) return done;
        if (auto done = passes::add_filter(volume.graph, pipelines_, volume.cascades[last], volume.images, occupied->work); !done) return done;
        return passes::add_emptiness(volume.graph, pipelines_, volume.cascades, volume.images, occupied->faces);
    };
    VolumeGraph emission = begin();
    if (auto done = add_volume(emission, true); !done) return done;
    if (auto done = finish(steps_->emission, emission); !done) return done;

    VolumeGraph reflect = begin();
    for (const auto& cascade : reflect.cascades)
        reflect.graph.add_pass(
            "gather nothing", graph::PassKind::transfer,
            [&](graph::PassBuilder& pass) { pass.write(cascade.gathered, graph::Usage::transfer_write); },
            [gathered = cascade.gathered](graph::PassContext& context) { context.commands.fill(context.buffer(gathered), 0); });
    if (auto done = add_volume(reflect, false); !done) return done;
    if (auto done = finish(steps_->reflect, reflect); !done) return done;

    VolumeGraph bounce = begin();
    for (const auto& cascade : bounce.cascades)
        if (auto done = passes::add_gather(bounce.graph, pipelines_, source.inputs, shown_inputs_, cascade, bounce.images); !done) return done;
    if (auto done = add_volume(bounce, false); !done) return done;
    if (auto done = finish(steps_->bounce, bounce); !done) return done;
    if (auto done = build_lit_bounce(source, add_volume); !done) return done;
    passes_known_ = true;
    return {};
}

}  // namespace heliodon::realtime
