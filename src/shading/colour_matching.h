#pragma once

#include <array>

namespace heliodon::shading {

/// CIE 1931 2° colour-matching functions and illuminant D65, 380 to 780 nm by 5 nm: CIE 018:2019 and ISO/CIE 11664-2:2022.
struct ColourMatching {
    double x, y, z, d65;
};
inline constexpr double first_nm = 380, step_nm = 5;
extern const std::array<ColourMatching, 81> colour_matching;

}  // namespace heliodon::shading
