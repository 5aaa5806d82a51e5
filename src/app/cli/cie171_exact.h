#pragma once

#include <functional>
#include <vector>

#include "core/math.h"

/// Answers of CIE 171:2006 that are integrals, by Gauss & Legendre's rule in double precision: no renderer in it.
namespace heliodon::cli {

/// Light that comes through (or off) a rectangle. Metres; u and v are perpendicular.
struct Aperture {
    glm::dvec3 corner{0}, u{0}, v{0};
    /// Places along v, from 0 to 1, where the radiance jumps (a horizon, an edge): integrated piece by piece.
    std::vector<double> breaks{};
};

/// cd/m² that comes from `direction` (unit, away from the receiver), and the aperture's transmittance by the cosine.
using Radiance = std::function<double(const glm::dvec3& direction)>;
using Transmittance = std::function<double(double cosine)>;

/// Lux at `position` on a plane facing `normal`: ∫ L τ cos θ cos θ' / r² dA over the aperture.
[[nodiscard]] double illuminance_through(const Aperture& aperture, const glm::dvec3& position, const glm::dvec3& normal,
                                         const Radiance& radiance, const Transmittance& transmittance = {});

}  // namespace heliodon::cli
