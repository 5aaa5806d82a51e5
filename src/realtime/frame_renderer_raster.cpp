// Who rasterizes what the camera and the lights see: the hardware, or compute.
#include "passes/cull/cull.h"
#include "realtime/frame_renderer.h"

namespace heliodon::realtime {

Result<void> FrameRenderer::choose_rasterizer() {
    // Graphics hardware of data-centre devices is slow, their compute is not; a CPU emulates both.
    const bool compute = settings_.rasterizer == Rasterizer::compute ||
                         (settings_.rasterizer == Rasterizer::automatic && !device_.info().is_cpu);
    const auto able = [&](std::uint64_t width, std::uint64_t height) {
        return compute && passes::can_raster_by_compute(device_, width * height);
    };
    // Blended surfaces are tested against the hardware's depth.
    wanted_.computed_visibility = !wanted_.blended && able(wanted_.width, wanted_.height);
    wanted_.computed_shadows = able(wanted_.shadow_size, wanted_.shadow_size);
    if (!wanted_.computed_visibility && !wanted_.computed_shadows) return {};
    wanted_.tests_opacity = inputs_.has_tested || inputs_.has_blended;
    camera_raster_.tests_opacity = shadow_raster_.tests_opacity = wanted_.tests_opacity;
    return list_raster_triangles();
}

Result<void> FrameRenderer::list_raster_triangles() {
    if (raster_revision_ == gpu_scene_.revision()) return {};
    const convert::FlatScene& flat = gpu_scene_.flat();
    std::vector<passes::TriangleRange> ranges;
    std::uint64_t triangles = 0;
    for (std::uint32_t i = 0; i < flat.instances().size(); ++i) {
        const shading::InstanceData& instance = flat.instances()[i];
        if ((instance.flags & shading::instance_flag_visible) == 0) continue;
        const Geometry* geometry = flat.geometries()[instance.geometry];
        if (!geometry || geometry->mesh.indices.empty()) continue;
        ranges.push_back({static_cast<std::uint32_t>(triangles), i});
        triangles += geometry->mesh.indices.size() / 3;
    }
    if (triangles > 0xffffffffull) return fail("render.rasterizer", "more triangles than compute can number");
    if (auto done = raster_ranges_.reserve(device_, ranges.size() * sizeof(passes::TriangleRange), 0); !done)
        return done;
    if (!ranges.empty())
        if (auto done = device_.upload<passes::TriangleRange>(raster_ranges_.buffer(), ranges); !done) return done;
    for (passes::ComputeRasterInputs* inputs : {&camera_raster_, &shadow_raster_}) {
        inputs->triangle_ranges = &raster_ranges_.buffer();
        inputs->range_count = static_cast<std::uint32_t>(ranges.size());
        inputs->triangle_count = static_cast<std::uint32_t>(triangles);
    }
    raster_revision_ = gpu_scene_.revision();
    return {};
}

Result<void> FrameRenderer::place_raster_views(passes::ComputeRasterInputs& inputs, GrowingBuffer& buffer,
                                               std::vector<shading::RasterView> views, std::uint64_t key_capacity) {
    inputs.batches = passes::raster_batches(views, key_capacity);
    inputs.views = &buffer.buffer();
    if (auto done = buffer.reserve(device_, views.size() * sizeof(shading::RasterView), 0); !done) return done;
    return views.empty() ? Result<void>{} : device_.upload<shading::RasterView>(buffer.buffer(), views);
}

Result<void> FrameRenderer::place_raster_camera(const glm::mat4& world_to_clip) {
    if (!key_.computed_visibility) return {};
    const std::uint64_t pixels = std::uint64_t(key_.width) * key_.height;
    return place_raster_views(camera_raster_, camera_raster_view_,
                              {passes::raster_view(world_to_clip, {0, 0}, {key_.width, key_.height}, 0, 0)},
                              passes::raster_key_capacity(device_, pixels));
}

Result<void> FrameRenderer::place_raster_shadows(std::span<const shading::ShadowViewData> views) {
    if (!key_.computed_shadows) return {};
    std::vector<shading::RasterView> raster_views;
    for (const shading::ShadowViewData& view : views)
        raster_views.push_back(passes::raster_view(view.world_to_clip, {view.corner_x, view.corner_y},
                                                   glm::uvec2(view.size), view.layer,
                                                   static_cast<std::uint32_t>(raster_views.size())));
    shadow_raster_.random_seed = shadow_inputs_.random_seed;
    return place_raster_views(shadow_raster_, shadow_raster_views_, std::move(raster_views), shadow_key_capacity(key_));
}

std::uint64_t FrameRenderer::shadow_key_capacity(const GraphKey& key) const {
    return passes::raster_key_capacity(device_, std::uint64_t{key.shadow_layers} * key.shadow_size * key.shadow_size);
}

Result<void> FrameRenderer::add_shadow_maps(graph::Graph& graph, const passes::ShadowMaps& maps) {
    if (wanted_.computed_shadows)
        return passes::add_shadow_by_compute(graph, pipelines_, inputs_, shadow_raster_, maps,
                                             shadow_key_capacity(wanted_));
    auto lists = passes::add_cull(graph, pipelines_, inputs_, {wanted_.shadow_views, wanted_.instance_capacity, true},
                                  shadow_cull_views_, shadow_inputs_.view_count);
    if (!lists) return tl::unexpected(lists.error());
    return passes::add_shadow(graph, pipelines_, inputs_, shadow_inputs_, *lists, maps);
}

Result<passes::Visibility> FrameRenderer::add_visibility(graph::Graph& graph, VkExtent2D extent,
                                                         passes::DrawLists& lists) {
    if (wanted_.computed_visibility)
        return passes::add_visibility_by_compute(graph, pipelines_, inputs_, camera_raster_, extent);
    auto culled = passes::add_cull(graph, pipelines_, inputs_, {1, wanted_.instance_capacity, false}, camera_view_,
                                   camera_view_count_);
    if (!culled) return tl::unexpected(culled.error());
    lists = *culled;
    return passes::add_visibility(graph, pipelines_, inputs_, camera_view_, lists, extent);
}

}  // namespace heliodon::realtime
