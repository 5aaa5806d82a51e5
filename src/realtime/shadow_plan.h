#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"
#include "passes/common/frame_shared.h"
#include "realtime/shadow_cascades.h"
#include "realtime/shadow_detail.h"
#include "shading/scene_data.h"

namespace heliodon::realtime {

/// Around a map's edge, so that taps beside a lookup stay inside the view.
inline constexpr double shadow_guard_texels = 2;

/// A square of the shadow map array, in texels; of size 0: no map.
struct ShadowPlace {
    std::uint32_t layer = 0, x = 0, y = 0, size = 0;
    bool operator==(const ShadowPlace&) const = default;
};

/// Lights whose shadow maps are resident together.
struct ShadowBatch {
    std::uint32_t first_light = 0, light_count = 0;  ///< in ShadowPlan::active_lights
    std::uint32_t first_view = 0, view_count = 0;    ///< in ShadowPlan::views
    std::uint32_t layer_count = 0;
};

/// What a batch may take.
struct ShadowBudget {
    std::uint32_t layer_size = 2048;  ///< texels; the largest map
    std::uint32_t layers = 16;
    std::uint32_t views = 32768;
};

/// Which lights shine, how many shadow views each needs, and where their maps lie. While all fit, each map is as large as
/// a layer. Where they do not, maps share layers, a light's the smaller the less it lights the scene; lights beyond
/// the number of views are lit in later batches. Every light casts its shadow. A directional light has a view for each
/// cascade, the narrowest first, and then one of the whole scene; those that are not needed have no map.
struct ShadowPlan {
    struct View {
        std::uint32_t light = 0;  ///< index in the light table
        std::uint32_t face = 0;   ///< of a cube; 0 for a single view; of a directional light: its cascade, then the whole scene
        bool cube = false;
        bool whole_scene = false;
        ShadowPlace place;
    };
    std::vector<std::uint32_t> active_lights;
    std::vector<std::uint32_t> shadow_of_light;  ///< LightData::shadow by light: first view of its batch, bit 31: a cube
    std::vector<View> views;
    std::vector<ShadowBatch> batches;            ///< at least one (of no lights, when none shines)
};
/// Whether two plans have the same views in the same order, wherever their maps lie.
[[nodiscard]] bool same_views(const ShadowPlan& a, const ShadowPlan& b);
/// And whether these lie at the same places.
[[nodiscard]] bool same_places(const ShadowPlan& a, const ShadowPlan& b);
/// `detail`, if any: maps are halved as long as their texels stay finer than who looks at them can tell.
[[nodiscard]] ShadowPlan plan_shadows(std::span<const shading::LightData> lights, const Bounds& scene, const ShadowBudget& budget,
                                      const ShadowDetail* detail = nullptr, const ShadowCascades& cascades = {});

/// The views as shaders want them. `jitter_texels` moves the texel grid, so that the mean over many shadow maps is
/// free of its stairs. `scene` bounds what casts shadows; `cascades`: those of the plan, or of a camera moved since.
[[nodiscard]] std::vector<shading::ShadowViewData> shadow_views(std::span<const ShadowPlan::View> views,
                                                                std::span<const shading::LightData> lights, const Bounds& scene,
                                                                glm::vec2 jitter_texels, const ShadowCascades& cascades = {});

}  // namespace heliodon::realtime
