#pragma once

#include <cstdint>

namespace heliodon {

/// Who casts the shadows of the sun and of directional lights in real time: shadow maps, or the volumes behind silhouettes.
enum class SunShadows : std::uint8_t { cascades, volumes };

inline constexpr int most_shadow_cascades = 8;

/// The scene file's `render.shadow_cascades`: shadow maps of slices of what the camera sees.
struct ShadowCascadeSettings {
    int count = 4;           ///< 1 to most_shadow_cascades
    float split = 0.5f;      ///< where slices end: 0 evenly, 1 by equal ratios (Zhang et al. 2006, their λ and its value)
    float blend = 0.125f;    ///< share of a map's half width over which the next one takes over, 0 to ½
    float distance_m = 0;    ///< farther, one map of the whole scene serves; 0: as far as the scene reaches
    bool operator==(const ShadowCascadeSettings&) const = default;
};

/// The scene file's `render.shadow_volumes`: how the triangles are found that the sun lights.
struct ShadowVolumeSettings {
    int map_size = 1024;               ///< texels an edge of the map of the whole scene, and of each part that is looked at closer
    float significant_px = 0.015625f;  ///< projected area in texels of the whole scene's map from which triangles are looked for
    bool operator==(const ShadowVolumeSettings&) const = default;
};

}  // namespace heliodon
