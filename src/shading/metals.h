#pragma once

#include <functional>

#include "core/math.h"

namespace heliodon::shading {

/// Metals whose index of refraction by wavelength is known here.
enum class Metal { gold, silver, copper, aluminium, iron, chromium };

/// Linear sRGB of what reflects `reflectance` (of wavelength in nm) under D65, white being 1: CIE 1931 2°, 380 to 780 nm.
[[nodiscard]] glm::dvec3 reflectance_to_rgb(const std::function<double(double nm)>& reflectance);

/// Linear sRGB of the metal's polished surface seen at this cosine, under D65. Colours out of the gamut are above 1 or below 0.
[[nodiscard]] glm::dvec3 metal_reflectance(Metal metal, double cosine);

/// An index n + ik a channel whose exact reflectance is the metal's at normal incidence, held to at most 0.9999, and as
/// near as can be at 82°. Between them it follows the spectrum within 0.015 (tests/shading/extended_models_test.cpp).
struct ConductorIndices {
    glm::vec3 eta{1}, k{0};
};
[[nodiscard]] ConductorIndices metal_indices(Metal metal);

}  // namespace heliodon::shading
