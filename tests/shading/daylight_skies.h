#pragma once

#include <numbers>

#include "core/units.h"
#include "shading/daylight.h"
#include "shading/sky.h"

namespace heliodon::shading {

inline constexpr double degree = std::numbers::pi / 180, diameter = 0.53 * degree;
inline constexpr std::uint32_t models[] = {sky_model_hosek, sky_model_preetham};

inline SkyData sky_of(std::uint32_t model, double turbidity, double elevation_deg, double albedo = 0.2) {
    SkyData sky{};
    const double elevation = elevation_deg * degree;
    set_daylight_sky({model, turbidity, albedo, 0.7, elevation, sunlight(model, turbidity, elevation, diameter)}, sky);
    return sky;
}

inline vec3 radiance(const SkyData& sky, double azimuth_deg, double elevation_deg) {
    return sky_radiance(sky, direction_from_azimuth(static_cast<float>(azimuth_deg * degree), static_cast<float>(elevation_deg * degree), 0), vec3(1));
}
inline double nits(const vec3& rgb) {
    return units::luminance(glm::dvec3(rgb));
}

}  // namespace heliodon::shading
