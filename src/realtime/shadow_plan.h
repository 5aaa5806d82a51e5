#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"
#include "passes/common/frame_shared.h"
#include "shading/scene_data.h"

namespace heliodon::realtime {

/// Lights whose shadow maps are resident together.
struct ShadowBatch {
    std::uint32_t first_light = 0, light_count = 0;  ///< in ShadowPlan::active_lights
    std::uint32_t first_view = 0, view_count = 0;    ///< in ShadowPlan::views
};

/// Which lights shine, how many shadow views each needs, and in which batches they fit a budget of layers.
/// Lights beyond one batch's budget are lit in later ones, so every light casts its shadow.
struct ShadowPlan {
    struct View {
        std::uint32_t light = 0;  ///< index in the light table
        std::uint32_t face = 0;   ///< of a cube; 0 for a single view
        bool cube = false;
    };
    std::vector<std::uint32_t> active_lights;
    std::vector<std::uint32_t> shadow_of_light;  ///< LightData::shadow by light: layer of the first view, bit 31: a cube
    std::vector<View> views;
    std::vector<ShadowBatch> batches;            ///< at least one (of no lights, when none shines)
};
[[nodiscard]] ShadowPlan plan_shadows(std::span<const shading::LightData> lights, std::uint32_t max_layers);

/// The views of one batch. `jitter_texels` moves the texel grid, so that the mean over many shadow maps is
/// free of its stairs. `scene` bounds what directional lights must cover.
[[nodiscard]] std::vector<shading::ShadowViewData> shadow_views(const ShadowPlan& plan, const ShadowBatch& batch,
                                                                std::span<const shading::LightData> lights,
                                                                const Bounds& scene, int map_size, glm::vec2 jitter_texels);

}  // namespace heliodon::realtime
