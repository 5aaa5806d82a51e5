#pragma once

#include <array>
#include <cmath>

#include "shading/scene_data.h"

namespace heliodon::shading {

/// What of the sun's disc is above the horizon: the share of its light, limb-darkened (light.h), and the elevation of
/// that part's middle, radians.
struct DiscAbove {
    double share = 0, elevation = 0;
};
/// `elevation` and angular `radius` of the disc in radians.
[[nodiscard]] DiscAbove disc_above(double elevation, double radius);

struct Sunlight {
    glm::dvec3 whole_disc{0};  ///< lux on a plane facing it, linear Rec. 709, were nothing of it hidden
    DiscAbove above;
    [[nodiscard]] glm::dvec3 normal() const { return above.share * whole_disc; }  ///< lux on a plane facing it
    [[nodiscard]] glm::dvec3 level() const { return std::sin(above.elevation) * normal(); }  ///< lux on level ground
};
/// The sun through an atmosphere of this turbidity. Under sky_model_hosek that of Hošek & Wilkie 2013, "Adding a
/// Solar-Radiance Function to the Hošek-Wilkie Skylight Model"; else by Preetham, Shirley & Smits 1999, appendix A.1.
/// Falls to 0 as the disc sinks below the horizon.
[[nodiscard]] Sunlight sunlight(std::uint32_t sky_model, double turbidity, double sun_elevation, double angular_diameter);

/// What daylight depends on. Angles in radians, azimuth clockwise from north, elevation of the apparent sun.
struct Daylight {
    std::uint32_t model = sky_model_hosek;  ///< or sky_model_preetham
    double turbidity = 3;
    double ground_albedo = 0.2;
    double sun_azimuth = 0, sun_elevation = 0;
    Sunlight sun;  ///< lights the ground too
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
/// X, Y and Z of the sun in lux (Y) on a plane facing it, `elevation` above the horizon.
[[nodiscard]] glm::dvec3 hosek_sun_xyz(double turbidity, double elevation);
/// Y in cd/m², x and y: Preetham, Shirley & Smits 1999, appendix A.2.
[[nodiscard]] DaylightCoefficients preetham_coefficients(double turbidity, double sun_elevation);

/// Lux on open ground with the sun at or below the horizon, from clear sky and sun: Janiczek & DeYoung 1987, "Computer
/// Programs for Sun and Moon Illuminance", U.S. Naval Observatory Circular 171; from −18° down that of stars and airglow.
[[nodiscard]] double twilight_illuminance(double sun_elevation);
/// CIE 1931 chromaticity of level ground's light with the sun 6° below the horizon: sunlight that air scatters once, after
/// the long way through the ozone that makes it blue (Hulburt 1953, "Explanation of the Brightness and Color of the Sky,
/// Particularly the Twilight Sky"), with the air, the aerosols of turbidity 3 and the 0.35 cm of ozone of Preetham, Shirley &
/// Smits 1999.
inline constexpr double civil_dusk_x = 0.254, civil_dusk_y = 0.266;

}  // namespace heliodon::shading
