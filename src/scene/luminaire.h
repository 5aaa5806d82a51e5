#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"

namespace heliodon {

/// What gives off the light, in the luminaire's own axes: +x lies at C0, +y is up.
enum class OpeningShape : std::uint8_t { point, box, cylinder_x, cylinder_y, cylinder_z, ellipsoid };
/// A box with one side of 0 is a rectangle, a cylinder of height 0 a disc; both shine to both sides.
struct LuminousOpening {
    OpeningShape shape = OpeningShape::point;
    glm::vec3 size_m{0};
};
/// "rectangle", "disc", …
[[nodiscard]] std::string describe(const LuminousOpening& opening);

/// Luminous intensities over a sphere of directions. Between the angles they are interpolated bilinearly; outside
/// the polar angles there is no light.
struct PhotometricWeb {
    /// Which way the polar angle 0 lies and the azimuth 0: −y and +x (C-γ, and type A), or −x and −y (type B).
    enum class Axis : std::uint8_t { vertical, horizontal } axis = Axis::vertical;
    std::vector<double> polar_rad;    ///< ascending, 0 to π, at least two
    std::vector<double> azimuth_rad;  ///< ascending from 0 to 2π (first and last alike); one: the same all round
    std::vector<double> candela;      ///< by azimuth, then by polar angle

    [[nodiscard]] double at(std::size_t azimuth, std::size_t polar) const { return candela[azimuth * polar_rad.size() + polar]; }
};
/// Flux in lm, the exact integral of the interpolated intensities, between two polar angles.
[[nodiscard]] double integrated_flux_lm(const PhotometricWeb& web, double polar_begin_rad, double polar_end_rad);

/// A luminaire as photometric files (IES LM-63, EULUMDAT) describe it.
struct Luminaire {
    std::string name;
    PhotometricWeb web;
    LuminousOpening opening;
    /// What a lamp gives when the luminaire is tilted away from where it was measured, by ascending angles; empty: all.
    std::vector<double> tilt_rad, tilt_factor;
    double flux_lm = 0;  ///< by integration
    double peak_cd = 0;

    [[nodiscard]] double factor_at_tilt(double angle_rad) const;
};
/// Fills flux_lm and peak_cd.
void integrate(Luminaire& luminaire);

}  // namespace heliodon
