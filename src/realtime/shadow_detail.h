#pragma once

#include <vector>

#include "core/math.h"
#include "passes/common/frame_shared.h"
#include "shading/scene_data.h"

namespace heliodon::realtime {

/// Who looks at shadows: pixels of a picture, and voxels. Texels of shadow maps need be no finer than they are.
struct ShadowDetail {
    glm::vec3 position{0}, forward{0}, ray_dx{0}, ray_dy{0};  ///< of the camera, as FrameData has them
    int width = 0, height = 0;
    float near_m = 0;
    float voxel_m = 0;  ///< edge of the finest voxels that maps light; 0: none
    glm::vec3 low{0}, high{0};  ///< bounds of the scene
    bool operator==(const ShadowDetail&) const = default;
};
[[nodiscard]] ShadowDetail shadow_detail(const shading::FrameData& camera, const Bounds& scene);

/// A shadow view before it has a place: what lies in it, and how wide it is there.
struct ShadowFrustum {
    std::vector<glm::dvec4> planes;  ///< dot(xyz, p) + w ≥ 0 within
    glm::dvec4 half_width{0};        ///< the same, of half the map's edge in metres at p
};

/// Texels an edge at which no texel of the view covers more than a pixel or a voxel where it falls on anything within
/// the scene's bounds that these see, both taken square to their rays.
[[nodiscard]] double texels_wanted(const ShadowFrustum& view, const ShadowDetail& detail);

}  // namespace heliodon::realtime
