// Shadow maps and what else the frame renderer prepares for lights.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "passes/light_grid/light_grid.h"
#include "realtime/area_light.h"
#include "realtime/camera_frame.h"
#include "realtime/frame_renderer.h"

namespace heliodon::realtime {
namespace {

// Shadow maps that a frame renders: those of 64 point lights. The maps of more lights take turns.
constexpr std::uint32_t views_a_turn = 384;

// Shadow maps resident at once: 16 layers of 2048².
constexpr std::uint64_t shadow_budget_bytes = 512ull << 20;
constexpr std::uint64_t shadow_texel_bytes = 8;  // depth and slope
constexpr std::uint32_t smallest_shadow_layers = 6;  // one cube
constexpr std::uint32_t fewest_shadow_views = std::max(6, most_shadow_cascades + 1);  // of one light: a cube's, or cascades
// What shadow views may draw: a command an instance, view and draw list.
constexpr std::uint64_t shadow_draw_budget_bytes = 256ull << 20;
constexpr std::uint32_t most_shadow_views = 65535;  // culling counts them in one dimension of a dispatch

ShadowBudget shadow_budget(const gpu::Device& device, int size, std::uint32_t instances) {
    const std::uint64_t layer_bytes = std::uint64_t(size) * size * shadow_texel_bytes;
    const std::uint64_t view_bytes = shading::draw_lists_per_view * sizeof(shading::DrawCommand) * instance_capacity(instances);
    ShadowBudget budget;
    budget.layer_size = static_cast<std::uint32_t>(size);
    budget.layers = std::clamp(static_cast<std::uint32_t>(shadow_budget_bytes / layer_bytes), smallest_shadow_layers,
                               device.limits().maxImageArrayLayers);
    budget.views = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(shadow_draw_budget_bytes / view_bytes,
                                                                        fewest_shadow_views, most_shadow_views));
    return budget;
}

}  // namespace

Result<void> FrameRenderer::plan_lights() {
    if (cascades_.count != settings_.shadow_cascades.count) cascades_ = {.count = settings_.shadow_cascades.count};
    const auto flat_lights = gpu_scene_.flat().lights();
    lights_.assign(flat_lights.begin(), flat_lights.end());
    volume_light_ = choose_volume_light();
    has_cone_shadows_ = false;
    for (shading::LightData& light : lights_)
        if (cone_shadows_ && light.type != shading::light_type_none && light.radius > 0) {
            const float radius = light.radius;
            light = center_of_area_light(light);
            light.cone_radius = radius;
            has_cone_shadows_ = true;
        }
    // Volumes have the sharp edges of a light without extent.
    if (volume_light_ != shading::no_light && lights_[volume_light_].radius > 0)
        lights_[volume_light_] = center_of_area_light(lights_[volume_light_]);
    ShadowPlan plan = plan_shadow_maps();
    // Maps that are rendered in turns stay where they are while the lights are the same ones.
    if (!refreshes_in_turns() || planned_size_ != shadow_map_size_ || !same_views(plan, plan_)) use_shadow_plan(std::move(plan));
    planned_size_ = shadow_map_size_;
    planned_lights_ = gpu_scene_.light_revision();
    planned_instances_ = instance_capacity(gpu_scene_.instance_count());
    has_area_lights_ = std::any_of(plan_.active_lights.begin(), plan_.active_lights.end(),
                                   [&](std::uint32_t light) { return lights_[light].radius > 0; });
    if (auto done = upload_visible_lights(); !done) return done;
    if (auto done = gpu_scene_.set_light_shadows(plan_.shadow_of_light, plan_.active_lights); !done) return done;
    for (const std::uint32_t light : plan_.active_lights)
        if (auto done = gpu_scene_.stand_in_for_light(light, lights_[light]); !done) return done;
    return {};
}

Result<void> FrameRenderer::upload_visible_lights() {
    std::vector<shading::LightData> visible;
    for (const std::uint32_t index : plan_.active_lights)
        if (const shading::LightData& light = gpu_scene_.flat().lights()[index]; light.radius > 0) visible.push_back(light);
    const std::array<std::uint32_t, 4> header{static_cast<std::uint32_t>(visible.size())};
    const std::uint64_t bytes = sizeof(header) + visible.size() * sizeof(shading::LightData);
    if (auto done = visible_lights_.reserve(device_, bytes, 0); !done) return done;
    if (auto done = device_.upload(visible_lights_.buffer(), std::span<const std::uint32_t>(header)); !done) return done;
    if (visible.empty()) return {};
    return device_.upload(visible_lights_.buffer(), std::span<const shading::LightData>(visible), sizeof(header));
}

ShadowPlan FrameRenderer::plan_shadow_maps() const {
    return plan_shadows(lights_, gpu_scene_.bounds(), shadow_budget(device_, shadow_map_size_, gpu_scene_.instance_count()),
                        shadow_detail_ ? &*shadow_detail_ : nullptr, cascades_);
}

void FrameRenderer::use_shadow_plan(ShadowPlan plan) {
    if (!same_places(plan, plan_)) ++shadow_places_;
    plan_ = std::move(plan);
    resident_shadows_ = {};
}

void FrameRenderer::fit_shadow_maps(const Camera& camera, const FrameSample& sample) {
    std::optional<ShadowDetail> detail;
    ShadowCascades cascades{.count = settings_.shadow_cascades.count};
    // Maps that take turns are small, and stay where they are.
    if (!sample.measures && !refreshes_in_turns()) {
        const Bounds& bounds = gpu_scene_.bounds();
        detail = shadow_detail(camera_frame(camera, bounds, wanted_.width, wanted_.height, glm::vec2(0)), bounds);
        cascades = shadow_cascades(settings_.shadow_cascades, *detail);
        // What a picture asks for without cones leaves the voxels' light as it is.
        const bool traced = sample.cone_traced || settings_.gi == "vct";
        cascades.whole_scene = traced;
        const glm::vec3 extent = bounds.extent();
        const float longest = std::max({extent.x, extent.y, extent.z});
        if (traced) detail->voxel_m = std::ldexp(longest / static_cast<float>(settings_.voxels), 1 - settings_.cascades);
        if (!shadow_maps_fit_picture_ || plan_.batches.size() > 1) detail.reset();
    }
    cascades.light_without_maps = light_without_maps(sample);
    if (detail == shadow_detail_ && cascades == cascades_) return;
    shadow_detail_ = detail;
    cascades_ = std::move(cascades);
    if (ShadowPlan plan = plan_shadow_maps(); !same_places(plan, plan_)) use_shadow_plan(std::move(plan));
}

bool FrameRenderer::refreshes_in_turns() const {
    return plan_.batches.size() == 1 && plan_.batches.front().view_count > views_a_turn;
}

std::span<const ShadowPlan::View> FrameRenderer::views_due(const FrameSample& sample, const ShadowBatch& batch, const ShadowKey& wanted) {
    const std::span views(plan_.views.data() + batch.first_view, batch.view_count);
    const bool same_scene = wanted.scene_revision == resident_shadows_.scene_revision;
    const bool any_resident = resident_shadows_.scene_revision != ShadowKey{}.scene_revision;
    const bool live = sample.count == 0;
    // A still picture shows no older scene's shadows.
    if (!refreshes_in_turns() || !any_resident || (!live && !same_scene)) {
        next_view_ = stale_views_ = 0;
        return views;
    }
    if (!same_scene) stale_views_ = batch.view_count;
    if (live && forced_shadows_) return {};  // the voxel volume took this frame's turn
    const std::uint32_t first = next_view_;
    std::uint32_t end = std::min(first + views_a_turn, batch.view_count);
    while (end < batch.view_count && views[end].face != 0) ++end;  // a cube's faces stay together
    next_view_ = end == batch.view_count ? 0 : end;
    stale_views_ -= std::min(stale_views_, end - first);
    return views.subspan(first, end - first);
}

Result<void> FrameRenderer::place_area_lights(const FrameSample& sample, std::span<const ShadowPlan::View> views) {
    placed_lights_ = lights_;
    if (!has_area_lights_) return {};
    for (const ShadowPlan::View& view : views) {
        shading::LightData& light = placed_lights_[view.light];
        if (view.face != 0 || light.radius <= 0) continue;
        // Every light goes through its points in an order of its own.
        light = sample.jitter_shadows ? point_of_area_light(light, sample_position(sample.shadow_index, 0, sample.seed + view.light + 1))
                                      : center_of_area_light(light);
        if (auto done = gpu_scene_.stand_in_for_light(view.light, light); !done) return done;
    }
    return {};
}

std::vector<shading::ShadowViewData> FrameRenderer::shadow_views_at(std::span<const ShadowPlan::View> views, const FrameSample& sample) const {
    glm::vec2 jitter(0);
    if (sample.jitter_shadows) jitter = sample_position(sample.shadow_index, 0, sample.seed) - 0.5f;
    auto result = shadow_views(views, placed_lights_, gpu_scene_.bounds(), jitter, cascades_);
    if (sample.jitter_shadows) return result;  // each is of one point of the light
    // Of half the sky the largest that is a number.
    const float widest = std::nextafter(glm::half_pi<float>(), 0.0f);
    for (std::size_t i = 0; i < views.size(); ++i)
        if (result[i].kind == shading::shadow_kind_orthographic)
            result[i].disc_tangent = std::tan(std::min(lights_[views[i].light].radius, widest));
    return result;
}

Result<void> FrameRenderer::record_shadows(gpu::Commands& commands, const FrameSample& sample, std::size_t batch,
                                           gpu::Timestamps* timestamps) {
    const ShadowKey wanted{gpu_scene_.revision(), batch, sample.shadow_index, sample.jitter_shadows};
    const bool resident = wanted == resident_shadows_ && stale_views_ == 0 && (!sample.force_shadows || forced_shadows_);
    const std::span all(plan_.views.data() + plan_.batches[batch].first_view, plan_.batches[batch].view_count);
    if (resident && (cascades_ == drawn_cascades_ || refreshes_in_turns())) return {};
    const auto due = resident ? all : views_due(sample, plan_.batches[batch], wanted);
    if (due.empty() && refreshes_in_turns()) return {};
    if (!resident) {
        if (auto done = place_area_lights(sample, due); !done) return done;
        if (auto done = record_light_grid(commands, sample, batch, timestamps); !done) return done;
    }
    const auto first = static_cast<std::size_t>(due.data() - all.data());
    const auto views = shadow_views_at(due, sample);
    resident_views_.resize(all.size());
    std::vector<shading::ShadowViewData> drawn;
    for (std::size_t i = 0; i < views.size(); ++i) {
        // Cascades that the camera has moved are drawn anew, what else is resident stays.
        const bool stays = resident && std::memcmp(&views[i], &resident_views_[first + i], sizeof(views[i])) == 0;
        resident_views_[first + i] = views[i];
        if (!stays && views[i].kind != shading::shadow_kind_none) drawn.push_back(views[i]);
    }
    drawn_cascades_ = cascades_;
    if (resident && drawn.empty()) return {};
    if (auto done = draw_shadow_maps(commands, sample, drawn, timestamps); !done) return done;
    if (!views.empty())
        if (auto done = device_.upload<shading::ShadowViewData>(shadow_views_, views, first * sizeof(shading::ShadowViewData)); !done)
            return done;
    resident_shadows_ = wanted;
    forced_shadows_ = forced_shadows_ || sample.force_shadows || (refreshes_in_turns() && sample.count == 0);
    return {};
}

Result<void> FrameRenderer::draw_shadow_maps(gpu::Commands& commands, const FrameSample& sample,
                                             std::span<const shading::ShadowViewData> views, gpu::Timestamps* timestamps) {
    std::vector<shading::ViewData> cull_views;
    shadow_inputs_.draws.clear();
    for (const shading::ShadowViewData& view : views) {
        shadow_inputs_.draws.push_back({static_cast<std::uint32_t>(cull_views.size()), view.layer,
                                        {{static_cast<int>(view.corner_x), static_cast<int>(view.corner_y)}, {view.size, view.size}}});
        cull_views.push_back({view.world_to_clip});
    }
    shadow_inputs_.view_count = static_cast<std::uint32_t>(views.size());
    shadow_inputs_.random_seed = sample.shadow_index + sample.seed;
    if (auto done = place_raster_shadows(views); !done) return done;
    if (!views.empty())
        if (auto done = device_.upload<shading::ViewData>(shadow_cull_views_, cull_views); !done) return done;
    shadow_maps_drawn_ += views.size();
    // Also without views: the graph brings the image into the layout that shading expects.
    return shadow_executor_->execute(commands, timestamps);
}

Result<void> FrameRenderer::record_light_grid(gpu::Commands& commands, const FrameSample& sample, std::size_t batch,
                                              gpu::Timestamps* timestamps) {
    const ShadowBatch& lights = plan_.batches[batch];
    const shading::LightGridHeader header = passes::light_grid_header(gpu_scene_.bounds(), lights.first_light, lights.light_count);
    if (header.edge == 0) return {};
    const std::pair key{gpu_scene_.revision(), batch};
    // Lights with an extent may have moved to another of their points.
    if (key == light_grid_key_ && !has_area_lights_ && !sample.force_shadows) return {};
    if (auto done = light_grid_.reserve(device_, passes::light_grid_bytes(header), 0); !done) return done;
    if (auto done = device_.upload(light_grid_.buffer(), std::span<const shading::LightGridHeader>(&header, 1)); !done) return done;
    const std::uint32_t scope = timestamps ? timestamps->begin(commands, "light grid") : 0;
    if (auto done = passes::record_light_grid(commands, pipelines_, inputs_, light_grid_.buffer(), header); !done) return done;
    if (timestamps) timestamps->end(commands, scope);
    light_grid_key_ = key;
    return {};
}

}  // namespace heliodon::realtime
