// The frame graphs of a frame, but for those of the voxel volume.
#include <algorithm>

#include "passes/accumulate/accumulate.h"
#include "passes/ambient_occlusion/ambient_occlusion.h"
#include "passes/blend/blend.h"
#include "passes/shadow_cones/shadow_cones.h"
#include "passes/tonemap/tonemap.h"
#include "realtime/frame_renderer.h"

namespace heliodon::realtime {
namespace {

// Shadows of cones are no finer than voxels, but end at edges.
constexpr std::uint32_t most_shadow_spacing = 2;  // pixels

/// Handles in `graph` for what `executor` exports as `ahead`.
SurfacesAhead imported(graph::Graph& graph, const graph::Executor& executor, const SurfacesAhead& ahead) {
    const auto image = [&](graph::ImageHandle handle) { return graph.import_image(executor.image(handle).description()); };
    const passes::Surfaces& surfaces = ahead.surfaces;
    return {{image(surfaces.places), image(surfaces.albedos), image(surfaces.lobes), image(surfaces.ids)},
            {image(ahead.weights.weights), graph.import_buffer(executor.buffer(ahead.weights.listed).description())}};
}

/// Binds them.
void bind(graph::Executor& executor, const SurfacesAhead& handles, const graph::Executor& from, const SurfacesAhead& ahead) {
    const auto bind_image = [&](graph::ImageHandle handle, graph::ImageHandle exported) { executor.bind(handle, from.image(exported)); };
    bind_image(handles.surfaces.places, ahead.surfaces.places);
    bind_image(handles.surfaces.albedos, ahead.surfaces.albedos);
    bind_image(handles.surfaces.lobes, ahead.surfaces.lobes);
    bind_image(handles.surfaces.ids, ahead.surfaces.ids);
    bind_image(handles.weights.weights, ahead.weights.weights);
    executor.bind(handles.weights.listed, from.buffer(ahead.weights.listed));
}

}  // namespace

Result<void> FrameRenderer::build_shadow_graph() {
    graph::Graph graph;
    const passes::ShadowMaps maps{graph.import_image(shadow_depth_.description()), graph.import_image(shadow_slope_.description())};
    if (auto done = add_shadow_maps(graph, maps); !done) return done;
    graph.export_image(maps.depth);
    graph.export_image(maps.slope);
    if (auto done = shadow_executor_->set_graph(graph); !done) return done;
    shadow_executor_->bind(maps.depth, shadow_depth_);
    shadow_executor_->bind(maps.slope, shadow_slope_);
    return {};
}

Result<void> FrameRenderer::build_surface_graph() {
    graph::Graph graph;
    if (!wanted_.surfaces_ahead) return surface_executor_->set_graph(graph);
    const VkExtent2D extent{static_cast<std::uint32_t>(wanted_.width), static_cast<std::uint32_t>(wanted_.height)};
    passes::DrawLists lists;
    auto visibility = add_visibility(graph, extent, lists);
    if (!visibility) return tl::unexpected(visibility.error());
    ahead_.surfaces = passes::create_surfaces(graph, *visibility, extent);
    if (auto done = passes::add_surfaces(graph, pipelines_, inputs_, lighting_, ahead_.surfaces, extent); !done) return done;
    auto weights = passes::add_cone_weights(graph, pipelines_, inputs_, lighting_, ahead_.surfaces, extent, {false, wanted_.cone_spacing});
    if (!weights) return tl::unexpected(weights.error());
    ahead_.weights = *weights;
    for (const graph::ImageHandle image : {ahead_.surfaces.ids, ahead_.surfaces.places, ahead_.surfaces.albedos, ahead_.surfaces.lobes,
                                           ahead_.weights.weights})
        graph.export_image(image);
    graph.export_buffer(ahead_.weights.listed);
    return surface_executor_->set_graph(graph);
}

Result<void> FrameRenderer::build_frame_graph() {
    const VkExtent2D extent{static_cast<std::uint32_t>(wanted_.width), static_cast<std::uint32_t>(wanted_.height)};
    graph::Graph graph;
    const passes::ShadowMaps maps{graph.import_image(shadow_depth_.description()), graph.import_image(shadow_slope_.description())};
    const graph::ImageHandle sum = graph.import_image(sum_.description());
    graph.export_image(sum);
    const passes::VolumeImages volume{graph.import_image(voxels_.inputs().faces->description()),
                                      graph.import_image(voxels_.inputs().depths->description()),
                                      graph.import_image(voxels_.inputs().lobes->description()),
                                      graph.import_buffer(voxels_.inputs().occupancy->description())};
    const bool ahead = wanted_.surfaces_ahead, follows = wanted_.cone_traced;
    passes::DrawLists lists;
    passes::Visibility visibility;
    SurfacesAhead seen;
    if (ahead) {
        seen = imported(graph, *surface_executor_, ahead_);
        visibility.ids = seen.surfaces.ids;
    } else {
        auto added = add_visibility(graph, extent, lists);
        if (!added) return tl::unexpected(added.error());
        visibility = *added;
        if (follows || wanted_.sky_occluded) seen.surfaces = passes::create_surfaces(graph, visibility, extent);
    }
    const graph::ImageHandle picture = passes::create_picture(graph, extent);
    passes::ShadeOptions options{.aov = wanted_.aov, .leaves = (follows || wanted_.sky_occluded) && !ahead ? &seen.surfaces : nullptr,
                                 .sky_follows = wanted_.sky_occluded,
                                 .shadow_spacing = std::min(wanted_.cone_spacing, most_shadow_spacing)};
    if (lighting_.shadows_traced && !wanted_.aov) {
        auto traced = passes::add_pixel_shadows(graph, pipelines_, inputs_, lighting_, visibility.ids, volume, extent, options.shadow_spacing);
        if (!traced) return tl::unexpected(traced.error());
        options.traced_shadows = *traced;
    }
    if (wanted_.volumes && !wanted_.aov) {
        auto shadowed = add_shadow_volumes(graph, extent, lists);
        if (!shadowed) return tl::unexpected(shadowed.error());
        options.shadowed = *shadowed;
        options.maps_follow = wanted_.maps_after_volumes;
    }
    const auto add_shade = [&] {
        return passes::add_shade(graph, pipelines_, inputs_, lighting_, visibility.ids, maps, volume, picture, extent, options);
    };
    if (!ahead)
        if (auto done = add_shade(); !done) return done;
    const passes::ConeTraceOptions cone_options{wanted_.aov, wanted_.cone_spacing};
    if (follows && !ahead) {
        auto weights = passes::add_cone_weights(graph, pipelines_, inputs_, lighting_, seen.surfaces, extent, cone_options);
        if (!weights) return tl::unexpected(weights.error());
        seen.weights = *weights;
    }
    const passes::ConeTrace cones{inputs_, lighting_, voxels_.inputs(), volume, seen.surfaces, seen.weights, extent, cone_options};
    passes::TracedCones traced;
    if (follows) {
        auto added = passes::add_cones(graph, pipelines_, cones);
        if (!added) return tl::unexpected(added.error());
        traced = *added;
    }
    // Cones that need not wait for shading are traced beside those of shadows.
    if (ahead)
        if (auto done = add_shade(); !done) return done;
    if (follows)
        if (auto done = passes::add_cone_light(graph, pipelines_, cones, traced, picture); !done) return done;
    if (wanted_.sky_occluded)
        if (auto done = passes::add_ambient_occlusion(graph, pipelines_, inputs_, lighting_, seen.surfaces, picture, extent, occlusion_,
                                                      wanted_.aov); !done)
            return done;
    graph::BufferHandle fragments;
    if (wanted_.blended && !wanted_.aov) {
        fragments = graph.import_buffer(fragments_.description());
        if (auto done = passes::add_blend(graph, pipelines_, inputs_, lighting_, camera_view_, lists, visibility, maps, volume,
                                          fragments, picture, extent, wanted_.cone_traced); !done)
            return done;
    }
    if (auto done = passes::add_accumulate(graph, pipelines_, picture, sum, replace_sum_, extent); !done) return done;
    graph::ImageHandle display;
    if (wanted_.display) {
        display = graph.import_image(display_.description());
        graph.export_image(display);
        auto exposure = passes::add_meter(graph, pipelines_, sum, exposure_, wanted_.metered, extent);
        if (!exposure) return tl::unexpected(exposure.error());
        if (auto done = passes::add_tonemap(graph, pipelines_, sum, *exposure, display, tonemap_, extent); !done) return done;
    }
    if (auto done = frame_executor_->set_graph(graph); !done) return done;
    frame_executor_->bind(maps.depth, shadow_depth_);
    frame_executor_->bind(maps.slope, shadow_slope_);
    frame_executor_->bind(sum, sum_);
    frame_executor_->bind(volume.faces, *voxels_.inputs().faces);
    frame_executor_->bind(volume.depths, *voxels_.inputs().depths);
    frame_executor_->bind(volume.lobes, *voxels_.inputs().lobes);
    frame_executor_->bind(volume.occupancy, *voxels_.inputs().occupancy);
    if (ahead) bind(*frame_executor_, seen, *surface_executor_, ahead_);
    if (fragments) frame_executor_->bind(fragments, fragments_);
    if (display) frame_executor_->bind(display, display_);
    return {};
}

}  // namespace heliodon::realtime
