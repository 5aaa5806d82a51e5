#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace heliodon::shading {

/// Preetham, Shirley & Smits 1999, table 2, by 10 nm from 380 nm: the sun's radiance (relative), and the absorption of
/// ozone (1/cm), water vapour and mixed gases, by Iqbal 1983.
struct SolarBand {
    double sun, ozone, water, gases;
};
extern const std::array<SolarBand, 38> solar_bands;

/// Optical depths from the ground to the zenith of appendix A.1: air, aerosols of Ångström's exponent 1.3; ozone by its column.
inline double air_depth(double micrometre) {
    return 0.008735 * std::pow(micrometre, -4.08);
}
inline double aerosol_depth(double micrometre, double turbidity) {
    return std::max(0.04608 * turbidity - 0.04586, 0.0) * std::pow(micrometre, -1.3);
}
inline constexpr double ozone_cm = 0.35;

}  // namespace heliodon::shading
