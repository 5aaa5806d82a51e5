#pragma once

#include "core/math.h"

namespace heliodon {

/// Temperatures that light has a chromaticity for, in kelvin.
inline constexpr float least_color_temperature_k = 1000, greatest_color_temperature_k = 25000;

/// CIE 1931 chromaticity (x, y) of daylight of a correlated colour temperature from 4000 K (CIE 15:2004, eq. 3.3 and 3.4), of
/// a black body below (Krystek 1985, "An algorithm to calculate correlated colour temperature", eq. 7).
[[nodiscard]] glm::vec2 white_chromaticity(float temperature_k);

/// Linear Rec. 709 to linear Rec. 709 such that a white of this chromaticity becomes neutral and keeps its luminance:
/// a von Kries adaptation to D65 of the responses of Lam's Bradford transform (1985). `chromaticity`: x, y > 0, x + y ≤ 1.
[[nodiscard]] glm::mat3 white_balance_matrix(glm::vec2 chromaticity);

}  // namespace heliodon
