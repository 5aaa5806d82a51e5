#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "realtime/shadow_detail.h"
#include "scene/sun_shadow_settings.h"

namespace heliodon::realtime {

/// What a camera sees up to some depth, in a sphere: it turns with the camera without changing size.
struct ShadowSlice {
    float near_m = 0, far_m = 0;  ///< depths for which no narrower slice serves
    glm::vec3 center{0};
    float radius = 0;
    bool operator==(const ShadowSlice&) const = default;
};

/// How shadow maps of directional lights follow the camera.
struct ShadowCascades {
    int count = 0;                    ///< views that each light has besides that of the whole scene
    float blend = 0;                  ///< share of a view's half width over which a wider one takes over
    std::vector<ShadowSlice> slices;  ///< at most `count`, narrowest first; views without one have no map
    bool reaches_all = false;         ///< the last slice ends behind everything that the camera sees
    bool whole_scene = true;          ///< more than the camera looks at shadows: voxels, sensors
    std::optional<std::uint32_t> light_without_maps;  ///< in the light table: its shadows are known otherwise
    bool operator==(const ShadowCascades&) const = default;
};

/// The slices of a camera that stands where `camera` says: they end at depths between equal steps and equal ratios.
[[nodiscard]] ShadowCascades shadow_cascades(const ShadowCascadeSettings& settings, const ShadowDetail& camera);

/// Half an edge, in metres, of the map of so many texels that holds a slice within its border.
[[nodiscard]] double cascade_half_width(const ShadowSlice& slice, float blend, std::uint32_t size);

/// A map's centre across the light: it moves by whole texels, a part of the map at a time, so that a map serves many frames.
[[nodiscard]] glm::dvec2 snapped_center(glm::dvec2 center, double half_width, std::uint32_t size);

}  // namespace heliodon::realtime
