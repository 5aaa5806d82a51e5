#include "shading/daylight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shading/cie_sky.h"
#include "shading/sky.h"

namespace heliodon::shading {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double night_elevation = -18 * degree, civil_elevation = -6 * degree;

/// Janiczek & DeYoung 1987: log10 of lux as cubics of elevation / 90°.
double log10_natural_illuminance(double elevation_deg) {
    struct Piece {
        double from_deg, l[4];
    };
    constexpr Piece pieces[] = {{-0.8, {2.88, 22.26, -207.64, 1034.30}},
                                {-5, {2.88, 21.81, -258.11, -858.36}},
                                {-12, {2.70, 12.17, -431.69, -1899.83}},
                                {-18, {13.84, 262.72, 1447.42, 2797.93}}};
    const double x = elevation_deg / 90;
    const Piece* piece = pieces;
    while (elevation_deg < piece->from_deg) ++piece;
    return ((piece->l[3] * x + piece->l[2]) * x + piece->l[1]) * x + piece->l[0];
}

void store(const DaylightCoefficients& coefficients, SkyData& sky) {
    for (std::size_t i = 0; i < coefficients.size(); ++i) sky.daylight[i] = vec4(vec3(coefficients[i]), 0);
}

/// What the dome of the sun on the horizon becomes with the sun below it. It has the illuminance that was measured from civil
/// dusk on; between sunset and then the model's own goes over to that. A growing share of it is an even white night.
DaylightCoefficients twilight(DaylightCoefficients dome, double elevation, SkyData& sky) {
    store(dome, sky);
    const double at_sunset = horizontal_illuminance(sky);
    const double own = std::clamp(1 - elevation / civil_elevation, 0.0, 1.0), even = std::clamp(elevation / night_elevation, 0.0, 1.0);
    const double wanted = twilight_illuminance(elevation) * std::pow(at_sunset / twilight_illuminance(0), own);
    sky.luminance = vec3(static_cast<float>(even * wanted / std::numbers::pi));
    const double scale = (1 - even) * wanted / at_sunset;
    // Preetham's second and third values are chromaticities, which no dimming changes.
    const glm::dvec3 dimmed = sky.model == sky_model_preetham ? glm::dvec3(scale, 1, 1) : glm::dvec3(scale);
    for (const std::size_t i : {2, 3, 5, 6, 7}) dome[i] *= dimmed;
    return dome;
}

}  // namespace

double twilight_illuminance(double sun_elevation) {
    // Even steps of a degree, so that nothing jumps where one cubic takes over from another.
    const double degrees = std::clamp(sun_elevation / degree, -18.0, 0.0), below = std::max(std::floor(degrees), -18.0);
    const double above = std::min(below + 1, 0.0);
    return std::pow(10, std::lerp(log10_natural_illuminance(below), log10_natural_illuminance(above), degrees - below));
}

void set_daylight_sky(const Daylight& daylight, SkyData& sky) {
    const double elevation = std::max(daylight.sun_elevation, 0.0);
    sky.model = daylight.model;
    sky.horizon = daylight.model == sky_model_hosek ? 0.01f : 0.0f;
    sky.sun_direction = direction_from_azimuth(static_cast<float>(daylight.sun_azimuth), static_cast<float>(elevation), sky.north_rad);
    sky.luminance = sky.ground = vec3(0);
    DaylightCoefficients dome = daylight.model == sky_model_hosek ? hosek_coefficients(daylight.turbidity, daylight.ground_albedo, elevation)
                                                                 : preetham_coefficients(daylight.turbidity, elevation);
    if (daylight.sun_elevation < 0) dome = twilight(dome, daylight.sun_elevation, sky);
    store(dome, sky);
    const glm::dvec3 on_ground = horizontal_illuminance_rgb(sky) + daylight.sun_illuminance * std::sin(elevation);
    sky.ground = vec3(daylight.ground_albedo / std::numbers::pi * on_ground);
}

}  // namespace heliodon::shading
