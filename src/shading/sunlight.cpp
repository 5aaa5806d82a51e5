#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "shading/colour_matching.h"
#include "shading/daylight.h"
#include "shading/sky.h"

namespace heliodon::shading {
namespace {

/// Preetham, Shirley & Smits 1999, table 2, by 10 nm from 380 nm: the sun's radiance (relative: it is scaled below), and the
/// absorption of ozone (1/cm), water vapour and mixed gases, by Iqbal 1983.
struct Band {
    double sun, ozone, water, gases;
};
constexpr std::array<Band, 38> bands{{
    {1655.9, 0, 0, 0},        {1623.37, 0, 0, 0},       {2112.75, 0, 0, 0},          {2588.82, 0, 0, 0},      {2582.91, 0, 0, 0},
    {2423.23, 0, 0, 0},       {2676.05, 0, 0, 0},       {2965.83, 0.003, 0, 0},      {3054.54, 0.006, 0, 0},  {3005.75, 0.009, 0, 0},
    {3066.37, 0.014, 0, 0},   {2883.04, 0.021, 0, 0},   {2871.21, 0.030, 0, 0},      {2782.5, 0.040, 0, 0},   {2710.06, 0.048, 0, 0},
    {2723.36, 0.063, 0, 0},   {2636.13, 0.075, 0, 0},   {2550.38, 0.085, 0, 0},      {2506.02, 0.103, 0, 0},  {2531.16, 0.120, 0, 0},
    {2535.59, 0.120, 0, 0},   {2513.42, 0.115, 0, 0},   {2463.15, 0.125, 0, 0},      {2417.32, 0.120, 0, 0},  {2368.53, 0.105, 0, 0},
    {2321.21, 0.090, 0, 0},   {2282.77, 0.079, 0, 0},   {2233.98, 0.067, 0, 0},      {2197.02, 0.057, 0, 0},  {2152.67, 0.048, 0, 0},
    {2109.79, 0.036, 0, 0},   {2072.81, 0.028, 0.016, 0}, {2024.04, 0.023, 0.024, 0}, {1987.08, 0.018, 0.0125, 0}, {1942.72, 0.014, 1, 0},
    {1907.24, 0.011, 0.87, 0}, {1862.89, 0.010, 0.061, 0}, {1825.92, 0.009, 0.001, 0},
}};
constexpr double extraterrestrial_lux = 133100;  // ASTM G173-03's spectrum outside the atmosphere, by ȳ

/// The share of light of `micrometre` that passes `mass` atmospheres: appendix A.1.
double transmittance(const Band& band, double micrometre, double mass, double turbidity) {
    constexpr double ozone_cm = 0.35, water_cm = 2, angstrom_exponent = 1.3;
    const double aerosols = std::max(0.04608 * turbidity - 0.04586, 0.0);
    double depth = 0.008735 * std::pow(micrometre, -4.08) * mass + aerosols * std::pow(micrometre, -angstrom_exponent) * mass;
    depth += band.ozone * ozone_cm * mass;
    depth += 1.41 * band.gases * mass / std::pow(1 + 118.93 * band.gases * mass, 0.45);
    depth += 0.2385 * band.water * water_cm * mass / std::pow(1 + 20.07 * band.water * water_cm * mass, 0.45);
    return std::exp(-depth);
}

/// The share of a disc that is above the horizon.
double share_above(double elevation, double radius) {
    const double x = std::clamp(elevation / radius, -1.0, 1.0);
    return (std::acos(-x) + x * std::sqrt(1 - x * x)) / std::numbers::pi;
}

}  // namespace

glm::dvec3 sun_illuminance(double turbidity, double sun_elevation, double angular_diameter) {
    const double elevation = std::max(sun_elevation, 0.0), zenith_angle_deg = 90 - glm::degrees(elevation);
    const double mass = 1 / (std::sin(elevation) + 0.15 * std::pow(93.885 - zenith_angle_deg, -1.253));  // Kasten 1966
    glm::dvec3 xyz(0);
    double outside = 0;
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const ColourMatching& match = colour_matching[2 * i];
        const double passed = bands[i].sun * transmittance(bands[i], (first_nm + 10 * static_cast<double>(i)) / 1000, mass, turbidity);
        xyz += passed * glm::dvec3(match.x, match.y, match.z);
        outside += bands[i].sun * match.y;
    }
    xyz *= extraterrestrial_lux / outside * share_above(sun_elevation, 0.5 * angular_diameter);
    return glm::dvec3(into_gamut(rgb_from_xyz(vec3(xyz)), static_cast<float>(xyz.y)));
}

}  // namespace heliodon::shading
