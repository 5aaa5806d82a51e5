#pragma once

#include <cstdint>
#include <optional>

#include "scene/civil_time.h"

namespace heliodon {

/// A point of the WGS84 ellipsoid.
struct Place {
    double latitude_rad = 0;   ///< geodetic, north positive
    double longitude_rad = 0;  ///< east positive
    double altitude_m = 0;     ///< above the ellipsoid
};

/// What bends light on its way to the ground.
struct Air {
    double pressure_hpa = 1010;
    double temperature_c = 10;
};

/// Where the middle of the sun's disc stands.
struct SunPosition {
    double azimuth_rad = 0;         ///< clockwise from north, 0 to 2π
    double elevation_rad = 0;       ///< apparent: lifted by refraction
    double elevation_true_rad = 0;  ///< topocentric, without refraction
    double distance_au = 1;
};
/// By IAU 2006 precession, IAU 2000A nutation and the Earth's motion of VSOP2000 (ERFA); UT1 is taken to be UTC, which
/// it is to 0.9 s: 0.004° of azimuth and elevation at most.
[[nodiscard]] SunPosition sun_position(const Place& place, double unix_s, const Air& air = {});

/// How far air lifts what stands at this true elevation; radians.
[[nodiscard]] double refraction_rad(double elevation_true_rad, const Air& air = {});

enum class SunState : std::uint8_t { rises_and_sets, polar_day, polar_night };
/// The sun's course from one lower culmination to the next, about the culmination that falls into the clock's day.
struct SunDay {
    SunState state = SunState::rises_and_sets;
    double solar_noon = 0;  ///< unix seconds
    std::optional<double> sunrise, sunset;  ///< at most one lacks where polar day or night begins or ends
};
/// Rising and setting is when the disc's upper limb touches the level horizon: its middle 50′ below, 34′ for refraction and
/// 16′ for the semi-diameter (U.S. Naval Observatory's and the almanacs' convention).
[[nodiscard]] SunDay sun_day(const Place& place, const CivilTime& time);

}  // namespace heliodon
