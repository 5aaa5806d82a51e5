#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "scene/sensor_reading.h"

namespace heliodon::cli {

/// A grid of illuminances as it was measured: row by row along u.
struct GridReadings {
    std::string name;
    SensorGrid grid;
    std::span<const SensorReading> readings;
};

/// The readings of `scene`'s sensors (in their order) that are grids.
[[nodiscard]] std::vector<GridReadings> grids_of(const Scene& scene, std::span<const SensorReading> readings);

/// Display-encoded colour of `share` in [0, 1]: the cube helix, whose brightness grows evenly, so that it reads in
/// grey too (Green 2011, "A colour scheme for the display of astronomical intensity images", eq. 2).
[[nodiscard]] glm::vec3 false_colour(double share);

/// A display-encoded picture of the grids one below the other, u to the right and v up, by one scale: interpolated
/// between the points, with iso-lines at round values, their numbers and a legend.
[[nodiscard]] Image draw_grids(std::span<const GridReadings> grids);

}  // namespace heliodon::cli
