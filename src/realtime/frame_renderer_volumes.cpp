// Shadow volumes: which light casts them, and what a frame does about it.
#include <algorithm>

#include "core/units.h"
#include "passes/cull/cull.h"
#include "realtime/frame_renderer.h"

namespace heliodon::realtime {

std::uint32_t FrameRenderer::choose_volume_light() const {
    std::uint32_t chosen = shading::no_light;
    if (settings_.sun_shadows != SunShadows::volumes) return chosen;
    float brightest = 0;
    const auto lights = gpu_scene_.flat().lights();
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const float lux = units::luminance(lights[i].intensity);
        if (lights[i].type != shading::light_type_directional || lux <= brightest) continue;
        brightest = lux;
        chosen = i;
    }
    return chosen;
}

/// Pixels of a picture know what volumes say; all else asks maps.
std::optional<std::uint32_t> FrameRenderer::light_without_maps(const FrameSample& sample) const {
    const bool pixels_alone = !sample.cone_traced && !sample.measures && sample.aov == shading::frame_aov_none;
    const bool volumes_alone = !gpu_scene_.has_tested() && !gpu_scene_.has_blended();
    if (volume_light_ == shading::no_light || !pixels_alone || !volumes_alone) return std::nullopt;
    return volume_light_;
}

Result<void> FrameRenderer::prepare_volumes(const FrameSample& sample) {
    if (sample.measures) return {};  // no picture
    wanted_.volumes = volume_light_ != shading::no_light;
    wanted_.maps_after_volumes = wanted_.volumes && (inputs_.has_tested || inputs_.has_blended);
    if (!wanted_.volumes) return {};
    return volumes_.update(gpu_scene_, inputs_, lights_[volume_light_].axis, settings_.shadow_volumes,
                           sample.volumes_behind);
}

void FrameRenderer::place_volumes(shading::FrameData& frame, std::size_t batch) {
    frame.volume_light = shading::no_light;
    if (!key_.volumes) return;
    const ShadowBatch& lights = plan_.batches[batch];
    const auto first = plan_.active_lights.begin() + lights.first_light, end = first + lights.light_count;
    if (const auto found = std::find(first, end, volume_light_); found != end)
        frame.volume_light = static_cast<std::uint32_t>(found - first);
    // A far plane would cut volumes open. Reversed depth has it at infinity as well.
    glm::mat4 rows = glm::transpose(frame.world_to_clip);
    rows[2] = {0, 0, 0, frame.near_m};
    volumes_.inputs().world_to_clip = glm::transpose(rows);
}

Result<graph::ImageHandle> FrameRenderer::add_shadow_volumes(graph::Graph& graph, VkExtent2D extent,
                                                             passes::DrawLists lists) {
    if (!lists.commands) {
        auto culled = passes::add_cull(graph, pipelines_, inputs_, {1, wanted_.instance_capacity, false}, camera_view_,
                                       camera_view_count_);
        if (!culled) return tl::unexpected(culled.error());
        lists = *culled;
    }
    return passes::add_shadow_volumes(graph, pipelines_, inputs_, volumes_.inputs(), lists, extent);
}

}  // namespace heliodon::realtime
