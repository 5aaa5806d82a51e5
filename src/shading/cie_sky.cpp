#include "shading/cie_sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/units.h"
#include "shading/quadrature.h"
#include "shading/sky.h"

namespace heliodon::shading {
namespace {

struct CieParameters {
    float a, b, c, d, e;
};
/// ISO 15469:2004 (CIE S 011), table 1, types 1 to 15.
constexpr std::array<CieParameters, cie_sky_types> cie_parameters{{{4.0f, -0.70f, 0, -1.0f, 0},
                                                                   {4.0f, -0.70f, 2, -1.5f, 0.15f},
                                                                   {1.1f, -0.8f, 0, -1.0f, 0},
                                                                   {1.1f, -0.8f, 2, -1.5f, 0.15f},
                                                                   {0, -1.0f, 0, -1.0f, 0},
                                                                   {0, -1.0f, 2, -1.5f, 0.15f},
                                                                   {0, -1.0f, 5, -2.5f, 0.30f},
                                                                   {0, -1.0f, 10, -3.0f, 0.45f},
                                                                   {-1.0f, -0.55f, 2, -1.5f, 0.15f},
                                                                   {-1.0f, -0.55f, 5, -2.5f, 0.30f},
                                                                   {-1.0f, -0.55f, 10, -3.0f, 0.45f},
                                                                   {-1.0f, -0.32f, 10, -3.0f, 0.45f},
                                                                   {-1.0f, -0.32f, 16, -3.0f, 0.30f},
                                                                   {-1.0f, -0.15f, 16, -3.0f, 0.30f},
                                                                   {-1.0f, -0.15f, 24, -2.8f, 0.15f}}};

}  // namespace

void set_cie_sky(int type, float zenith_luminance, float ground_albedo, float sun_azimuth, float sun_elevation, SkyData& sky) {
    sky.sun_direction = direction_from_azimuth(sun_azimuth, sun_elevation, sky.north_rad);
    sky.luminance = vec3(zenith_luminance);
    sky.model = sky_model_overcast;
    if (type <= cie_sky_types) {
        const CieParameters& p = cie_parameters[static_cast<std::size_t>(type - 1)];
        sky.model = sky_model_cie;
        sky.gradation_indicatrix = vec4(p.a, p.b, p.c, p.d);
        sky.indicatrix_e = p.e;
        // ISO 15469:2004, eq. 1: relative to the zenith, where the sun is its zenith angle away.
        const float sun_zenith_angle = 0.5f * pi - sun_elevation;
        sky.luminance /= cie_gradation(p.a, p.b, 1.0f) * cie_indicatrix(p.c, p.d, p.e, sun_zenith_angle);
    }
    sky.ground = vec3(static_cast<float>(ground_albedo * horizontal_illuminance(sky) / pi));
}

glm::dvec3 horizontal_illuminance_rgb(const SkyData& sky) {
    // The sines of elevation below and above the sun's, denser towards it, where the sky has its cusp. Both sides of the
    // sun are alike.
    static const GaussLegendre<16> rule;
    const double sun = std::clamp(double(sky.sun_direction.y), 0.0, 1.0), azimuth_of_sun = std::atan2(sky.sun_direction.x, sky.sun_direction.z);
    glm::dvec3 sum(0);
    for (const double extent : {-sun, 1 - sun})
        for (std::size_t i = 0; i < rule.x.size(); ++i) {
            const double sine = sun + extent * rule.x[i] * rule.x[i], cosine = std::sqrt(1 - sine * sine);
            const double weight = 2 * rule.x[i] * std::abs(extent) * rule.weight[i] * sine;
            for (std::size_t j = 0; j < rule.x.size(); ++j) {
                const double azimuth = azimuth_of_sun + std::numbers::pi * rule.x[j];
                const vec3 direction(cosine * std::sin(azimuth), sine, cosine * std::cos(azimuth));
                sum += weight * rule.weight[j] * glm::dvec3(sky_radiance(sky, direction, vec3(1.0f)));
            }
        }
    return 2 * std::numbers::pi * sum;
}

double horizontal_illuminance(const SkyData& sky) {
    return units::luminance(horizontal_illuminance_rgb(sky));
}

}  // namespace heliodon::shading
