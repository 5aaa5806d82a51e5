#include "shading/daylight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"
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

/// CIE 1931 XYZ of linear Rec. 709: IEC 61966-2-1:1999.
glm::dvec3 xyz_from_rgb(const glm::dvec3& rgb) {
    return {0.4124 * rgb.r + 0.3576 * rgb.g + 0.1805 * rgb.b, units::luminance(rgb), 0.0193 * rgb.r + 0.1192 * rgb.g + 0.9505 * rgb.b};
}

/// The dome of the sun on the horizon, `sky`, becomes that of the sun below it. Its illuminance and chromaticity are those
/// of twilight from civil dusk on; between sunset and then the model's own go over to these, in even steps of the
/// logarithm. A growing share of it is an even night, which is white at last.
void darken(double elevation, SkyData& sky) {
    const glm::dvec3 at_sunset = xyz_from_rgb(horizontal_illuminance_rgb(sky));
    const double own = std::clamp(1 - elevation / civil_elevation, 0.0, 1.0), even = std::clamp(elevation / night_elevation, 0.0, 1.0);
    const double night = std::clamp((elevation - civil_elevation) / (night_elevation - civil_elevation), 0.0, 1.0);
    const double lux = twilight_illuminance(elevation) * std::pow(at_sunset.y / twilight_illuminance(0), own);
    const glm::dvec3 dusk(civil_dusk_x / civil_dusk_y, 1, (1 - civil_dusk_x - civil_dusk_y) / civil_dusk_y);
    const glm::dvec3 faded = glm::mix(dusk, xyz_from_rgb(glm::dvec3(1)), night);
    const glm::dvec3 level = lux * glm::pow(at_sunset / at_sunset.y, glm::dvec3(own)) * glm::pow(faded, glm::dvec3(1 - own));
    const glm::dvec3 of_night = even / std::numbers::pi * level;
    sky.luminance = into_gamut(rgb_from_xyz(vec3(of_night)), static_cast<float>(of_night.y));
    sky.daylight[9] = vec4(vec3((1 - even) * level / at_sunset), 0);
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
    const DaylightCoefficients dome = daylight.model == sky_model_hosek
                                          ? hosek_coefficients(daylight.turbidity, daylight.ground_albedo, elevation)
                                          : preetham_coefficients(daylight.turbidity, elevation);
    for (std::size_t i = 0; i < dome.size(); ++i) sky.daylight[i] = vec4(vec3(dome[i]), 0);
    sky.daylight[9] = vec4(1);
    if (daylight.sun_elevation < 0) darken(daylight.sun_elevation, sky);
    const glm::dvec3 on_ground = horizontal_illuminance_rgb(sky) + daylight.sun.level();
    sky.ground = vec3(daylight.ground_albedo / std::numbers::pi * on_ground);
}

}  // namespace heliodon::shading
