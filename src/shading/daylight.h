#pragma once

#include <array>

#include "shading/scene_data.h"

namespace heliodon::shading {

/// What daylight depends on. Angles in radians, azimuth clockwise from north, elevation of the apparent sun.
struct Daylight {
    std::uint32_t model = sky_model_hosek;  ///< or sky_model_preetham
    double turbidity = 3;
    double ground_albedo = 0.2;
    double sun_azimuth = 0, sun_elevation = 0;
    glm::dvec3 sun_illuminance{0};  ///< lux on a plane facing the sun, which lights the ground too
};
/// Turbidities for which the models have figures. Preetham's fit is to those from 2 to 6; below 2 its zenith turns black.
inline constexpr double least_turbidity_hosek = 1, least_turbidity_preetham = 2, most_turbidity = 10;

/// Makes `sky` (whose north is set) this daylight. With the sun below the horizon the dome of the setting sun fades as
/// twilight was measured to and turns even, down to a moonless night's sky from −18° on.
void set_daylight_sky(const Daylight& daylight, SkyData& sky);

/// daylight_values' A, B, C, D, E, F, G, I, H of three values.
using DaylightCoefficients = std::array<glm::dvec3, 9>;
/// X, Y and Z in cd/m² (Y): Hošek & Wilkie 2012, section 5.
[[nodiscard]] DaylightCoefficients hosek_coefficients(double turbidity, double ground_albedo, double sun_elevation);
/// Y in cd/m², x and y: Preetham, Shirley & Smits 1999, appendix A.2.
[[nodiscard]] DaylightCoefficients preetham_coefficients(double turbidity, double sun_elevation);

/// Lux on open ground with the sun at or below the horizon, from clear sky and sun: Janiczek & DeYoung 1987, "Computer
/// Programs for Sun and Moon Illuminance", U.S. Naval Observatory Circular 171; from −18° down that of stars and airglow.
[[nodiscard]] double twilight_illuminance(double sun_elevation);

/// Lux on a plane facing the sun, linear Rec. 709, through an atmosphere of this turbidity: Preetham, Shirley & Smits 1999,
/// appendix A.1. Falls to 0 as the disc sinks below the horizon.
[[nodiscard]] glm::dvec3 sun_illuminance(double turbidity, double sun_elevation, double angular_diameter);

}  // namespace heliodon::shading
