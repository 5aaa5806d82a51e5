#pragma once

#include <numbers>

#include "shading/daylight.h"

namespace heliodon::shading {

inline constexpr double degree = std::numbers::pi / 180, diameter = 0.53 * degree;
inline constexpr std::uint32_t models[] = {sky_model_hosek, sky_model_preetham};

inline SkyData sky_of(std::uint32_t model, double turbidity, double elevation_deg, double albedo = 0.2) {
    SkyData sky{};
    const double elevation = elevation_deg * degree;
    set_daylight_sky({model, turbidity, albedo, 0.7, elevation, sunlight(model, turbidity, elevation, diameter)}, sky);
    return sky;
}

}  // namespace heliodon::shading
