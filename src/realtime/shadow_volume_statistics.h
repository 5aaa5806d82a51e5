#pragma once

#include <cstdint>
#include <vector>

namespace heliodon {

/// The triangles that have shadow volumes: those and only those that the light reaches; these and all with which there
/// are fewer silhouettes; or all that face it. The shadows are the same.
enum class VolumesBehind : std::uint8_t { lit, fewest, all };

/// What the shadow volumes of one light are made of, as they were last made.
struct ShadowVolumeStatistics {
    std::uint32_t triangles = 0;  ///< of all surfaces that cast volumes
    std::uint32_t caps = 0;       ///< those with a volume
    std::uint32_t edges = 0;      ///< silhouettes
    std::uint32_t sides = 0;      ///< each edge as often as it bounds
    std::uint32_t parts = 0;      ///< of the map of lit triangles that were drawn
    std::vector<std::uint32_t> found_by_round;  ///< significant triangles that its parts of each size showed first
    std::uint32_t builds = 0;     ///< so often they were made
    double build_ms = 0;          ///< of the last time: wall clock, the device's work awaited
};

}  // namespace heliodon
