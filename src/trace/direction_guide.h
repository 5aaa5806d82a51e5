#pragma once

#include <span>
#include <vector>

#include "shading/sampling.h"

namespace heliodon::trace {

/// A density over the hemisphere above a plane that follows where light comes from. Cells are even in azimuth and in
/// the squared sine of the polar angle, so that cosine-weighted directions fall evenly into them; within a cell the
/// density goes with the cosine. Directions are local: z is the plane's normal.
class DirectionGuide {
public:
    struct Sampled {
        shading::vec3 direction;
        float pdf;  ///< per steradian
    };

    /// Cosine-weighted.
    DirectionGuide() : DirectionGuide(1, std::vector<double>(1, 0.0), 0.0) {}
    /// `light`: for each of side² cells, row by row of the polar angle, the root of the mean square of what a
    /// cosine-weighted direction of the cell brings. That is the density of least variance (Vorba et al. 2019, "Path
    /// Guiding in Production", section 10: second moments). `share` in [0, 1] of the samples follows it; a part of them
    /// and all others are cosine-weighted, for what the pilot missed.
    DirectionGuide(int side, std::span<const double> light, double share);

    [[nodiscard]] Sampled sample(shading::vec2 u) const;
    [[nodiscard]] float pdf(shading::vec3 local) const;

    /// A cosine-weighted direction of cell (column, row), `within` it in [0, 1)².
    [[nodiscard]] static shading::vec3 direction_in(int side, int column, int row, shading::vec2 within);

private:
    [[nodiscard]] float cell_density(int column, int row) const;  ///< relative to cosine-weighted directions

    int side_;
    std::vector<float> rows_, columns_;  ///< cumulative; the columns of each row after another
};

}  // namespace heliodon::trace
