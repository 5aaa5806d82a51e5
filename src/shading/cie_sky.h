#pragma once

#include "shading/scene_data.h"

namespace heliodon::shading {

inline constexpr int cie_sky_types = 15;

/// Makes `sky` (whose north is set) one of ISO 15469:2004's fifteen types with this luminance at the zenith (cd/m²), or,
/// of any higher number, the traditional overcast one, over a diffuse ground of this albedo that the sky lights.
/// Angles in radians, azimuth clockwise from north, elevation from the horizon.
void set_cie_sky(int type, float zenith_luminance, float ground_albedo, float sun_azimuth, float sun_elevation, SkyData& sky);

/// Lux on the open ground under a sky of a formula, by quadrature to 2·10⁻⁵. The sun's own light is no part of it.
[[nodiscard]] double horizontal_illuminance(const SkyData& sky);
/// The same, linear Rec. 709.
[[nodiscard]] glm::dvec3 horizontal_illuminance_rgb(const SkyData& sky);

}  // namespace heliodon::shading
