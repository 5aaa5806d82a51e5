#pragma once

namespace heliodon {

/// What RenderSettings may ask for: voxels an edge are a power of two, cones a multiple of the hemisphere's.
inline constexpr int fewest_voxels = 32, most_voxels = 512;
inline constexpr int most_voxel_cascades = 8;
inline constexpr int most_counted_bounces = 64;
inline constexpr int hemisphere_cones = 9, most_cones = 144;

}  // namespace heliodon
