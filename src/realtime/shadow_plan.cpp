#include "realtime/shadow_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace heliodon::realtime {
namespace {

using shading::LightData;
using shading::ShadowViewData;

constexpr std::uint32_t cube_flag = 0x80000000u;
// A spot's single perspective view loses resolution in its middle as the cone opens; beyond this
// half-angle a cube's faces have more.
constexpr float widest_single_view_tan = 1.7320508f;  // 60°
// Texels around the edge so that taps beside a lookup stay inside the view.
constexpr float guard_texels = 2.0f;

bool shines(const LightData& light) {
    return light.type != shading::light_type_none && (light.intensity.x > 0 || light.intensity.y > 0 || light.intensity.z > 0);
}

float spot_tan(const LightData& light) {
    const float c = std::max(light.cos_outer, 1e-4f);
    return std::sqrt(std::max(0.0f, 1.0f - c * c)) / c;
}

bool needs_cube(const LightData& light) {
    if (light.type == shading::light_type_directional) return false;
    return light.type != shading::light_type_spot || light.cos_outer <= 0.0f || spot_tan(light) > widest_single_view_tan;
}

struct Axes {
    glm::vec3 right, up, forward;
};

Axes axes_along(glm::vec3 forward) {
    const glm::vec3 helper = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 right = glm::normalize(glm::cross(forward, helper));
    return {right, glm::cross(right, forward), forward};
}

Axes face_axes(std::uint32_t face) {
    static constexpr std::array<glm::vec3, 6> forward{glm::vec3(1, 0, 0),  glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0),
                                                      glm::vec3(0, -1, 0), glm::vec3(0, 0, 1),  glm::vec3(0, 0, -1)};
    return axes_along(forward[face]);
}

glm::mat4 from_rows(glm::vec4 x, glm::vec4 y, glm::vec4 z, glm::vec4 w) { return glm::transpose(glm::mat4(x, y, z, w)); }

/// The row that gives dot(axis, p − origin).
glm::vec4 offset_row(glm::vec3 axis, glm::vec3 origin) { return {axis, -glm::dot(axis, origin)}; }

ShadowViewData perspective_view(const Axes& axes, glm::vec3 origin, float tangent, float near_m, glm::vec2 jitter_ndc) {
    ShadowViewData view{};
    view.kind = shading::shadow_kind_perspective;
    view.origin = origin;
    view.axis_u = axes.right * tangent;
    view.axis_v = axes.up * tangent;
    view.near_m = near_m;
    view.forward = axes.forward;
    const glm::vec4 w = offset_row(axes.forward, origin);
    view.world_to_clip = from_rows(offset_row(axes.right / tangent, origin) + jitter_ndc.x * w,
                                   offset_row(axes.up / tangent, origin) + jitter_ndc.y * w, {0, 0, 0, near_m}, w);
    return view;
}

ShadowViewData orthographic_view(const Axes& axes, const Bounds& scene, float guard, glm::vec2 jitter_ndc) {
    glm::vec3 low(std::numeric_limits<float>::infinity()), high(-std::numeric_limits<float>::infinity());
    const Bounds bounds = scene.empty() ? Bounds{glm::vec3(-1), glm::vec3(1)} : scene;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                          corner & 4 ? bounds.max.z : bounds.min.z);
        const glm::vec3 local(glm::dot(p, axes.right), glm::dot(p, axes.up), glm::dot(p, axes.forward));
        low = glm::min(low, local);
        high = glm::max(high, local);
    }
    // A margin of a thousandth keeps flat scenes from a range of zero and what lies on the box inside it.
    const float margin = 1e-3f * std::max(glm::length(high - low), 1e-6f);
    const glm::vec3 center = 0.5f * (low + high);
    const glm::vec2 half = (0.5f * glm::vec2(high - low) + margin) * guard;
    ShadowViewData view{};
    view.kind = shading::shadow_kind_orthographic;
    view.origin = axes.right * center.x + axes.up * center.y + axes.forward * (low.z - margin);
    view.axis_u = axes.right * half.x;
    view.axis_v = axes.up * half.y;
    view.forward = axes.forward;
    view.range_m = high.z - low.z + 2.0f * margin;
    const glm::vec4 one(0, 0, 0, 1);
    view.world_to_clip = from_rows(offset_row(axes.right / half.x, view.origin) + jitter_ndc.x * one,
                                   offset_row(axes.up / half.y, view.origin) + jitter_ndc.y * one,
                                   one - offset_row(axes.forward / view.range_m, view.origin), one);
    return view;
}

}  // namespace

ShadowPlan plan_shadows(std::span<const LightData> lights, std::uint32_t max_layers) {
    ShadowPlan plan;
    plan.shadow_of_light.assign(lights.size(), shading::no_texture);
    ShadowBatch batch;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        if (!shines(lights[i])) continue;
        const bool cube = needs_cube(lights[i]);
        const std::uint32_t count = cube ? 6 : 1;
        if (batch.view_count + count > max_layers) {
            plan.batches.push_back(batch);
            batch = {static_cast<std::uint32_t>(plan.active_lights.size()), 0, static_cast<std::uint32_t>(plan.views.size()), 0};
        }
        plan.shadow_of_light[i] = batch.view_count | (cube ? cube_flag : 0);
        plan.active_lights.push_back(i);
        for (std::uint32_t face = 0; face < count; ++face) plan.views.push_back({i, face, cube});
        ++batch.light_count;
        batch.view_count += count;
    }
    plan.batches.push_back(batch);
    return plan;
}

std::vector<ShadowViewData> shadow_views(const ShadowPlan& plan, const ShadowBatch& batch, std::span<const LightData> lights,
                                         const Bounds& scene, int map_size, glm::vec2 jitter_texels) {
    std::vector<ShadowViewData> views;
    const glm::vec2 jitter_ndc = jitter_texels * (2.0f / static_cast<float>(map_size));
    const float guard = 1.0f + 2.0f * guard_texels / static_cast<float>(map_size);
    // Depth is near/w in 32-bit floats, as precise at any near distance; nearer than this, nothing blocks.
    const float near_m = std::max(scene.diagonal(), 1e-6f) * (1.0f / 65536.0f);
    for (std::uint32_t i = 0; i < batch.view_count; ++i) {
        const ShadowPlan::View& source = plan.views[batch.first_view + i];
        const LightData& light = lights[source.light];
        ShadowViewData view;
        if (light.type == shading::light_type_directional)
            view = orthographic_view(axes_along(light.axis), scene, guard, jitter_ndc);
        else if (source.cube)
            view = perspective_view(face_axes(source.face), light.position, guard, near_m, jitter_ndc);
        else
            view = perspective_view(axes_along(light.axis), light.position, spot_tan(light) * guard + 1e-5f, near_m, jitter_ndc);
        view.layer = i;
        views.push_back(view);
    }
    return views;
}

}  // namespace heliodon::realtime
