#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/cli/false_colour_plan.h"
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

/// A display-encoded picture of the grids one below the other, u to the right and v up, by one scale: interpolated
/// between the points, with iso-lines at round values, their numbers and a legend.
[[nodiscard]] Image draw_grids(std::span<const GridReadings> grids);

/// A display-encoded picture of a picture's luminance (cd/m², or lux), with iso-lines, their numbers and a legend beside it.
[[nodiscard]] Image draw_in_false_colour(const Image& light, const IsoScale& scale, const std::string& unit);

}  // namespace heliodon::cli
