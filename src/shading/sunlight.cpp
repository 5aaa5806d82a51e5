#include <array>
#include <cmath>
#include <numbers>

#include "shading/colour_matching.h"
#include "shading/daylight.h"
#include "shading/light.h"
#include "shading/quadrature.h"
#include "shading/sky.h"
#include "shading/solar_bands.h"

namespace heliodon::shading {

const std::array<SolarBand, 38> solar_bands{{
    {1655.9, 0, 0, 0},        {1623.37, 0, 0, 0},       {2112.75, 0, 0, 0},          {2588.82, 0, 0, 0},      {2582.91, 0, 0, 0},
    {2423.23, 0, 0, 0},       {2676.05, 0, 0, 0},       {2965.83, 0.003, 0, 0},      {3054.54, 0.006, 0, 0},  {3005.75, 0.009, 0, 0},
    {3066.37, 0.014, 0, 0},   {2883.04, 0.021, 0, 0},   {2871.21, 0.030, 0, 0},      {2782.5, 0.040, 0, 0},   {2710.06, 0.048, 0, 0},
    {2723.36, 0.063, 0, 0},   {2636.13, 0.075, 0, 0},   {2550.38, 0.085, 0, 0},      {2506.02, 0.103, 0, 0},  {2531.16, 0.120, 0, 0},
    {2535.59, 0.120, 0, 0},   {2513.42, 0.115, 0, 0},   {2463.15, 0.125, 0, 0},      {2417.32, 0.120, 0, 0},  {2368.53, 0.105, 0, 0},
    {2321.21, 0.090, 0, 0},   {2282.77, 0.079, 0, 0},   {2233.98, 0.067, 0, 0},      {2197.02, 0.057, 0, 0},  {2152.67, 0.048, 0, 0},
    {2109.79, 0.036, 0, 0},   {2072.81, 0.028, 0.016, 0}, {2024.04, 0.023, 0.024, 0}, {1987.08, 0.018, 0.0125, 0}, {1942.72, 0.014, 1, 0},
    {1907.24, 0.011, 0.87, 0}, {1862.89, 0.010, 0.061, 0}, {1825.92, 0.009, 0.001, 0},
}};

namespace {

constexpr double extraterrestrial_lux = 133100;  // ASTM G173-03's spectrum outside the atmosphere, by ȳ

/// The share of light of `micrometre` that passes `mass` atmospheres: appendix A.1.
double transmittance(const SolarBand& band, double micrometre, double mass, double turbidity) {
    constexpr double water_cm = 2;
    double depth = (air_depth(micrometre) + aerosol_depth(micrometre, turbidity) + band.ozone * ozone_cm) * mass;
    depth += 1.41 * band.gases * mass / std::pow(1 + 118.93 * band.gases * mass, 0.45);
    depth += 0.2385 * band.water * water_cm * mass / std::pow(1 + 20.07 * band.water * water_cm * mass, 0.45);
    return std::exp(-depth);
}

/// Preetham, Shirley & Smits 1999: X, Y and Z in lux (Y) on a plane facing the sun.
glm::dvec3 preetham_sun_xyz(double turbidity, double elevation) {
    const double zenith_angle_deg = 90 - glm::degrees(elevation);
    const double mass = 1 / (std::sin(elevation) + 0.15 * std::pow(93.885 - zenith_angle_deg, -1.253));  // Kasten 1966
    glm::dvec3 xyz(0);
    double outside = 0;
    for (std::size_t i = 0; i < solar_bands.size(); ++i) {
        const ColourMatching& match = colour_matching[2 * i];
        const double passed = solar_bands[i].sun * transmittance(solar_bands[i], (first_nm + 10 * static_cast<double>(i)) / 1000, mass, turbidity);
        xyz += passed * glm::dvec3(match.x, match.y, match.z);
        outside += solar_bands[i].sun * match.y;
    }
    return extraterrestrial_lux / outside * xyz;
}

}  // namespace

DiscAbove disc_above(double elevation, double radius) {
    if (elevation >= radius) return {1, elevation};
    if (elevation <= -radius) return {0, 0};
    // In radii from the middle: y = −cos ψ upwards, x = −sin ψ cos φ across. Its luminance is smooth in ψ and φ.
    static const GaussLegendre<16> rule;
    const double horizon = std::acos(elevation / radius);
    double light = 0, moment = 0;
    for (std::size_t i = 0; i < 16; ++i)
        for (std::size_t j = 0; j < 16; ++j) {
            const double psi = std::lerp(horizon, std::numbers::pi, rule.x[i]), phi = std::numbers::pi * rule.x[j];
            const double y = -std::cos(psi), x = -std::sin(psi) * std::cos(phi);
            const double area = std::sin(psi) * std::sin(psi) * std::sin(phi) * rule.weight[i] * rule.weight[j];
            const double element = area * limb_darkening(static_cast<float>(x * x + y * y));
            light += element;
            moment += element * y;
        }
    // ∫∫ dx dy = (π − horizon) π ∑ over a disc of area π
    return {light * (std::numbers::pi - horizon), elevation + radius * moment / light};
}

Sunlight sunlight(std::uint32_t sky_model, double turbidity, double sun_elevation, double angular_diameter) {
    const DiscAbove above = disc_above(sun_elevation, 0.5 * angular_diameter);
    if (above.share <= 0) return {};
    const glm::dvec3 xyz = sky_model == sky_model_hosek ? hosek_sun_xyz(turbidity, above.elevation) : preetham_sun_xyz(turbidity, above.elevation);
    return {glm::dvec3(into_gamut(rgb_from_xyz(vec3(xyz)), static_cast<float>(xyz.y))), above};
}

}  // namespace heliodon::shading
