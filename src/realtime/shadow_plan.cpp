#include "realtime/shadow_plan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/units.h"
#include "realtime/light_axes.h"

namespace heliodon::realtime {
namespace {

using shading::LightData;
using shading::ShadowViewData;

constexpr std::uint32_t cube_flag = 0x80000000u;
// A spot's single perspective view loses resolution in its middle as the cone opens; beyond this
// half-angle a cube's faces have more.
constexpr float widest_single_view_tan = 1.7320508f;  // 60°
constexpr auto guard_texels = static_cast<float>(shadow_guard_texels);
constexpr std::uint32_t no_map = ~0u;  // instead of a number of halvings

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

/// Lights with shadows by cones need no map.
std::uint32_t view_count(const LightData& light, int cascades) {
    if (light.cone_radius > 0) return 0;
    if (light.type == shading::light_type_directional) return static_cast<std::uint32_t>(cascades) + 1;
    return needs_cube(light) ? 6 : 1;
}

LightAxes face_axes(std::uint32_t face) {
    static constexpr std::array<glm::vec3, 6> forward{glm::vec3(1, 0, 0),  glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0),
                                                      glm::vec3(0, -1, 0), glm::vec3(0, 0, 1),  glm::vec3(0, 0, -1)};
    return axes_along(forward[face]);
}

glm::mat4 from_rows(glm::vec4 x, glm::vec4 y, glm::vec4 z, glm::vec4 w) { return glm::transpose(glm::mat4(x, y, z, w)); }

/// The row that gives dot(axis, p − origin).
glm::vec4 offset_row(glm::vec3 axis, glm::vec3 origin) { return {axis, -glm::dot(axis, origin)}; }

ShadowViewData perspective_view(const LightAxes& axes, glm::vec3 origin, float tangent, float near_m, glm::vec2 jitter_ndc) {
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

/// Of a rectangle across the light, as deep as the scene.
ShadowViewData orthographic_view(const LightAxes& axes, const Bounds& seen, glm::vec2 center, glm::vec2 half, glm::vec2 jitter_ndc) {
    ShadowViewData view{};
    view.kind = shading::shadow_kind_orthographic;
    view.origin = axes.right * center.x + axes.up * center.y + axes.forward * seen.min.z;
    view.axis_u = axes.right * half.x;
    view.axis_v = axes.up * half.y;
    view.forward = axes.forward;
    view.range_m = seen.extent().z;
    const glm::vec4 one(0, 0, 0, 1);
    view.world_to_clip = from_rows(offset_row(axes.right / half.x, view.origin) + jitter_ndc.x * one,
                                   offset_row(axes.up / half.y, view.origin) + jitter_ndc.y * one,
                                   one - offset_row(axes.forward / view.range_m, view.origin), one);
    return view;
}

ShadowViewData directional_view(const ShadowPlan::View& source, const LightData& light, const Bounds& scene, glm::vec2 jitter_ndc,
                                const ShadowCascades& cascades) {
    const LightAxes axes = axes_along(light.axis);
    const Bounds seen = seen_along(axes, scene);
    if (source.whole_scene) {
        const float guard = 1.0f + 2.0f * guard_texels / static_cast<float>(source.place.size);
        return orthographic_view(axes, seen, seen.center(), 0.5f * glm::vec2(seen.extent()) * guard, jitter_ndc);
    }
    const ShadowSlice& slice = cascades.slices[source.face];
    const double half = cascade_half_width(slice, cascades.blend, source.place.size);
    const glm::dvec2 across(glm::dot(glm::dvec3(axes.right), glm::dvec3(slice.center)), glm::dot(glm::dvec3(axes.up), glm::dvec3(slice.center)));
    ShadowViewData view = orthographic_view(axes, seen, snapped_center(across, half, source.place.size), glm::vec2(half), jitter_ndc);
    view.wider = 1;
    view.border = cascades.blend;
    return view;
}

/// Of perspective_view().
ShadowFrustum perspective_frustum(const LightAxes& axes, glm::vec3 origin, float tangent) {
    const auto through = [&](glm::dvec3 inward) { return glm::dvec4(inward, -glm::dot(inward, glm::dvec3(origin))); };
    const glm::dvec3 forward = double(tangent) * glm::dvec3(axes.forward);
    ShadowFrustum frustum;
    for (const glm::dvec3& axis : {glm::dvec3(axes.right), glm::dvec3(axes.up)})
        for (const double sign : {1.0, -1.0}) frustum.planes.push_back(through(forward + sign * axis));
    frustum.half_width = through(forward);
    return frustum;
}

/// Of a directional light's map of the whole scene.
float whole_half_width(const LightData& light, const Bounds& scene) {
    const glm::vec3 extent = seen_along(axes_along(light.axis), scene).extent();
    return 0.5f * std::max(extent.x, extent.y);
}

ShadowFrustum frustum_of(const ShadowPlan::View& view, const LightData& light, const Bounds& scene) {
    if (light.type != shading::light_type_directional)
        return view.cube ? perspective_frustum(face_axes(view.face), light.position, 1)
                         : perspective_frustum(axes_along(light.axis), light.position, spot_tan(light));
    ShadowFrustum frustum;  // holds the scene
    frustum.half_width.w = whole_half_width(light, scene);
    return frustum;
}

/// Lux that the light gives a plane facing it at a typical distance of the scene's surfaces.
float typical_illuminance(const LightData& light, const Bounds& scene) {
    const float luminance = heliodon::units::luminance(light.intensity);
    if (light.type == shading::light_type_directional || scene.empty()) return luminance;
    const glm::vec3 offset = light.position - scene.center();
    const float radius = std::max(0.5f * scene.diagonal(), 1e-6f);
    return luminance / std::max(glm::dot(offset, offset), radius * radius);
}

// Smaller maps would be mostly guard texels.
constexpr std::uint32_t smallest_map = 16;

/// How often the maps of a batch are halved: by what the picture can show, and by what fits.
class MapSizes {
public:
    explicit MapSizes(const ShadowBudget& budget)
        : layer_size_(budget.layer_size),
          most_halvings_(budget.layer_size > smallest_map ? std::bit_width(budget.layer_size / smallest_map) - 1 : 0),
          capacity_(budget.layers * cells(0)) {}

    [[nodiscard]] std::uint32_t most_halvings() const { return most_halvings_; }
    /// Squares of the smallest map in one halved so often.
    [[nodiscard]] std::uint64_t cells(std::uint32_t halvings) const { return halvings == no_map ? 0 : 1ull << 2 * (most_halvings_ - halvings); }
    [[nodiscard]] std::uint64_t capacity() const { return capacity_; }
    /// How often a map may be halved that is to keep so many texels an edge.
    [[nodiscard]] std::uint32_t halvings_for(double texels) const {
        std::uint32_t halvings = 0;
        while (halvings < most_halvings_ && (layer_size_ >> (halvings + 1)) >= texels + 2 * guard_texels) ++halvings;
        return halvings;
    }

    struct Light {
        float illuminance = 0;
        std::vector<std::uint32_t> least{};  ///< halvings of each view
        std::uint32_t halvings = 0;          ///< of each that has not more already
    };
    /// Squares of the smallest map in all of a light's that are halved so often.
    [[nodiscard]] std::uint64_t cells(const Light& light, std::uint32_t halvings) const {
        std::uint64_t sum = 0;
        for (const std::uint32_t least : light.least) sum += cells(std::max(least, halvings));
        return sum;
    }
    /// A shadow's edge is wrong by a texel, ∝ 1/size, where a light's illuminance E is missing or too much. Σ E/size is
    /// least at a given Σ size² where size ∝ E^⅓.
    void choose(std::vector<Light>& lights) const {
        float brightest = 0;
        for (const Light& light : lights) brightest = std::max(brightest, light.illuminance);
        std::uint64_t used = 0;
        for (int quarter_octaves = 0;; ++quarter_octaves) {
            used = 0;
            for (Light& light : lights) {
                const float halvings = 0.25f * static_cast<float>(quarter_octaves) - std::log2(light.illuminance / brightest) / 3;
                light.halvings = static_cast<std::uint32_t>(
                    quarter_octaves == 0 ? 0.0f : std::clamp(std::ceil(halvings), 0.0f, static_cast<float>(most_halvings_)));
                used += cells(light, light.halvings);
            }
            const bool smallest = std::all_of(lights.begin(), lights.end(), [&](const Light& l) { return l.halvings == most_halvings_; });
            if (used <= capacity_ || smallest) break;
        }
        // What is left over doubles the maps of the brightest.
        std::vector<Light*> order;
        for (Light& light : lights) order.push_back(&light);
        std::stable_sort(order.begin(), order.end(), [](const Light* a, const Light* b) { return a->illuminance > b->illuminance; });
        for (Light* light : order) {
            if (light->halvings == 0) continue;
            const std::uint64_t more = cells(*light, light->halvings - 1) - cells(*light, light->halvings);
            if (used + more > capacity_) break;
            used += more;
            --light->halvings;
        }
    }

private:
    std::uint32_t layer_size_, most_halvings_;
    std::uint64_t capacity_;
};

/// The even bits of `code`: Morton order (Morton 1966) fills a layer with squares of falling size without a gap.
std::uint32_t even_bits(std::uint64_t code) {
    std::uint32_t result = 0;
    for (std::uint32_t bit = 0; bit < 32; ++bit) result |= static_cast<std::uint32_t>(code >> 2 * bit & 1) << bit;
    return result;
}

/// How many slices are narrower than the whole scene.
std::size_t slices_worth_a_map(const LightData& light, const Bounds& scene, const ShadowBudget& budget, const ShadowCascades& cascades) {
    const float whole = whole_half_width(light, scene);
    const auto useless = std::find_if(cascades.slices.begin(), cascades.slices.end(), [&](const ShadowSlice& slice) {
        return cascade_half_width(slice, cascades.blend, budget.layer_size) >= whole;
    });
    return static_cast<std::size_t>(useless - cascades.slices.begin());
}

/// How often a directional light's map may be halved at least; `slices` have one.
std::uint32_t least_halvings(const ShadowPlan::View& view, const LightData& light, const Bounds& scene, const MapSizes& sizes,
                             const ShadowBudget& budget, const ShadowDetail* detail, const ShadowCascades& cascades, std::size_t slices) {
    if (cascades.light_without_maps == view.light) return no_map;
    if (!view.whole_scene) {
        if (view.face >= slices) return no_map;
        if (!detail) return 0;
        const ShadowSlice& slice = cascades.slices[view.face];
        const double pixel = std::min(glm::length(detail->ray_dx), glm::length(detail->ray_dy)) * slice.near_m;
        return sizes.halvings_for(2 * cascade_half_width(slice, cascades.blend, budget.layer_size) / pixel);
    }
    const bool seen = slices < cascades.slices.size() || !cascades.reaches_all || slices == 0;
    if (!seen && !cascades.whole_scene) return no_map;
    if (!detail) return 0;
    ShadowDetail beyond = *detail;  // the last slice
    if (slices > 0) beyond.near_m = std::max(beyond.near_m, cascades.slices[slices - 1].far_m);
    return sizes.halvings_for(texels_wanted(frustum_of(view, light, scene), beyond));
}

/// Sizes and places of the maps of one batch.
void place_maps(ShadowPlan& plan, ShadowBatch& batch, std::span<const LightData> lights, const Bounds& scene,
                const ShadowBudget& budget, const ShadowDetail* detail, const ShadowCascades& cascades) {
    const MapSizes sizes(budget);
    std::vector<MapSizes::Light> chosen;
    std::vector<std::uint32_t> halvings, order;
    std::uint32_t view = batch.first_view;
    for (std::uint32_t i = 0; i < batch.light_count; ++i) {
        const LightData& light = lights[plan.active_lights[batch.first_light + i]];
        chosen.push_back({typical_illuminance(light, scene)});
        const bool directional = light.type == shading::light_type_directional;
        const std::size_t slices = directional ? slices_worth_a_map(light, scene, budget, cascades) : 0;
        for (std::uint32_t n = view_count(light, cascades.count); n > 0; --n, ++view)
            chosen.back().least.push_back(
                directional ? least_halvings(plan.views[view], light, scene, sizes, budget, detail, cascades, slices)
                : detail    ? sizes.halvings_for(texels_wanted(frustum_of(plan.views[view], light, scene), *detail))
                            : 0);
    }
    sizes.choose(chosen);
    for (const MapSizes::Light& light : chosen)
        for (const std::uint32_t least : light.least) halvings.push_back(std::max(least, light.halvings));
    order.resize(halvings.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return halvings[a] < halvings[b]; });
    std::uint64_t next = 0;
    for (const std::uint32_t view : order) {
        if (halvings[view] == no_map) continue;
        const std::uint64_t cell = next % sizes.cells(0), edge = budget.layer_size;
        plan.views[batch.first_view + view].place = {static_cast<std::uint32_t>(next / sizes.cells(0)),
                                                     static_cast<std::uint32_t>(even_bits(cell) * edge >> sizes.most_halvings()),
                                                     static_cast<std::uint32_t>(even_bits(cell >> 1) * edge >> sizes.most_halvings()),
                                                     budget.layer_size >> halvings[view]};
        next += sizes.cells(halvings[view]);
    }
    batch.layer_count = static_cast<std::uint32_t>((next + sizes.cells(0) - 1) / sizes.cells(0));
}

}  // namespace

ShadowPlan plan_shadows(std::span<const LightData> lights, const Bounds& scene, const ShadowBudget& budget,
                        const ShadowDetail* detail, const ShadowCascades& cascades) {
    ShadowPlan plan;
    plan.shadow_of_light.assign(lights.size(), shading::no_texture);
    const std::uint64_t most_views = std::min<std::uint64_t>(budget.views, MapSizes(budget).capacity());
    ShadowBatch batch;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        if (!shines(lights[i])) continue;
        const bool cube = needs_cube(lights[i]);
        const std::uint32_t count = view_count(lights[i], cascades.count);
        if (batch.light_count > 0 && batch.view_count + count > most_views) {
            plan.batches.push_back(batch);
            batch = {static_cast<std::uint32_t>(plan.active_lights.size()), 0, static_cast<std::uint32_t>(plan.views.size()), 0};
        }
        if (count > 0) plan.shadow_of_light[i] = batch.view_count | (cube ? cube_flag : 0);
        plan.active_lights.push_back(i);
        const bool directional = lights[i].type == shading::light_type_directional;
        for (std::uint32_t face = 0; face < count; ++face) plan.views.push_back({i, face, cube, directional && face + 1 == count, {}});
        ++batch.light_count;
        batch.view_count += count;
    }
    plan.batches.push_back(batch);
    for (ShadowBatch& planned : plan.batches) place_maps(plan, planned, lights, scene, budget, detail, cascades);
    return plan;
}

bool same_views(const ShadowPlan& a, const ShadowPlan& b) {
    return a.active_lights == b.active_lights && a.shadow_of_light == b.shadow_of_light && a.batches.size() == b.batches.size() &&
           std::equal(a.views.begin(), a.views.end(), b.views.begin(), b.views.end(), [](const auto& x, const auto& y) {
               return x.light == y.light && x.face == y.face && x.cube == y.cube && x.whole_scene == y.whole_scene;
           });
}

bool same_places(const ShadowPlan& a, const ShadowPlan& b) {
    return same_views(a, b) && std::equal(a.views.begin(), a.views.end(), b.views.begin(), b.views.end(),
                                          [](const auto& x, const auto& y) { return x.place == y.place; });
}

std::vector<ShadowViewData> shadow_views(std::span<const ShadowPlan::View> sources, std::span<const LightData> lights,
                                         const Bounds& scene, glm::vec2 jitter_texels, const ShadowCascades& cascades) {
    std::vector<ShadowViewData> views;
    // Depth is near/w in 32-bit floats, as precise at any near distance; nearer than this, nothing blocks.
    const float near_m = std::max(scene.diagonal(), 1e-6f) * (1.0f / 65536.0f);
    for (const ShadowPlan::View& source : sources) {
        const LightData& light = lights[source.light];
        if (source.place.size == 0) {
            ShadowViewData none{};
            none.kind = shading::shadow_kind_none;
            none.wider = source.whole_scene ? 0 : 1;
            views.push_back(none);
            continue;
        }
        const auto map_size = static_cast<float>(source.place.size);
        const glm::vec2 jitter_ndc = jitter_texels * (2.0f / map_size);
        const float guard = 1.0f + 2.0f * guard_texels / map_size;
        ShadowViewData view;
        if (light.type == shading::light_type_directional)
            view = directional_view(source, light, scene, jitter_ndc, cascades);
        else if (source.cube)
            view = perspective_view(face_axes(source.face), light.position, guard, near_m, jitter_ndc);
        else
            view = perspective_view(axes_along(light.axis), light.position, spot_tan(light) * guard + 1e-5f, near_m, jitter_ndc);
        view.layer = source.place.layer;
        view.corner_x = source.place.x;
        view.corner_y = source.place.y;
        view.size = source.place.size;
        views.push_back(view);
    }
    return views;
}

}  // namespace heliodon::realtime
