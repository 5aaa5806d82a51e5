#include "scene/sun_position.h"

#include <erfa.h>
#include <erfam.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math.h"

namespace heliodon {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double day_s = 86400;
constexpr double unix_epoch_jd = 2440587.5;
constexpr double degree = pi / 180;
constexpr double rising_elevation = -50.0 / 60 * degree;

/// TT − UT1 in seconds before UTC had its own definition: Stephenson, Morrison & Hohenkerk 2016, table S15 (Δt), every ten
/// years from 1900. A second more moves the sun by 0.04″.
double delta_t_before_1960(double year) {
    constexpr std::array<double, 7> table{-2.8, 10.4, 21.1, 24.0, 24.3, 29.1, 33.1};
    const double x = std::clamp((year - 1900) / 10, 0.0, 6.0);
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(x), table.size() - 2);
    return std::lerp(table[i], table[i + 1], x - static_cast<double>(i));
}

/// TT − UTC in seconds; the last known count of leap seconds holds for the time to come.
double tt_minus_utc(double unix_s) {
    int year = 0, month = 0, day = 0;
    double fraction = 0, tai_minus_utc = 0;
    eraJd2cal(unix_epoch_jd, unix_s / day_s, &year, &month, &day, &fraction);
    if (year < 1960) return delta_t_before_1960(year + (month - 0.5) / 12);
    eraDat(year, month, day, fraction, &tai_minus_utc);
    return tai_minus_utc + ERFA_TTMTAI;
}

/// From the Earth's centre to where the sun appears, in metres, in axes that turn with the Earth.
glm::dvec3 sun_from_earth_m(double unix_s) {
    const double ut = unix_s / day_s, tt = ut + tt_minus_utc(unix_s) / day_s;
    double heliocentric[2][3], barycentric[2][3];
    eraEpv00(unix_epoch_jd, tt, heliocentric, barycentric);  // TDB is TT to 2 ms
    const double distance = eraPm(heliocentric[0]);  // au
    double towards[3], velocity[3], apparent[3], celestial_to_terrestrial[3][3], terrestrial[3];
    for (int i = 0; i < 3; ++i) {
        towards[i] = -heliocentric[0][i] / distance;
        velocity[i] = barycentric[1][i] * (ERFA_AULT / day_s);  // au a day, in units of the speed of light
    }
    eraAb(towards, velocity, distance, std::sqrt(1 - eraPdp(velocity, velocity)), apparent);
    eraC2t06a(unix_epoch_jd, tt, unix_epoch_jd, ut, 0, 0, celestial_to_terrestrial);
    eraRxp(celestial_to_terrestrial, apparent, terrestrial);
    return glm::dvec3(terrestrial[0], terrestrial[1], terrestrial[2]) * (distance * ERFA_DAU);
}

/// East, north and up of the sun from the place, in metres.
glm::dvec3 local_sun_m(const Place& place, double unix_s) {
    double site[3];
    eraGd2gc(ERFA_WGS84, place.longitude_rad, place.latitude_rad, place.altitude_m, site);
    const glm::dvec3 v = sun_from_earth_m(unix_s) - glm::dvec3(site[0], site[1], site[2]);
    const double sl = std::sin(place.longitude_rad), cl = std::cos(place.longitude_rad);
    const double sp = std::sin(place.latitude_rad), cp = std::cos(place.latitude_rad);
    return {-sl * v.x + cl * v.y, -sp * cl * v.x - sp * sl * v.y + cp * v.z, cp * cl * v.x + cp * sl * v.y + sp * v.z};
}

double true_elevation(const glm::dvec3& enu) {
    return std::atan2(enu.z, std::hypot(enu.x, enu.y));
}

/// The sun's hour angle, −π to π: 0 where it culminates.
double hour_angle(const Place& place, double unix_s) {
    const glm::dvec3 sun = sun_from_earth_m(unix_s);
    return std::remainder(place.longitude_rad - std::atan2(sun.y, sun.x), 2 * pi);
}

/// When the sun's middle crosses the elevation of rising, between two moments of which one is above it.
double crossing(const Place& place, double below, double above) {
    constexpr double precise_s = 0.05;
    while (std::abs(above - below) > precise_s) {
        const double middle = 0.5 * (below + above);
        (true_elevation(local_sun_m(place, middle)) < rising_elevation ? below : above) = middle;
    }
    return 0.5 * (below + above);
}

}  // namespace

double refraction_rad(double elevation_true_rad, const Air& air) {
    // Saemundsson 1986, Sky & Telescope 72, p. 70 (in minutes of arc), scaled by density as Reda & Andreas 2003, eq. 42.
    const double density = air.pressure_hpa / 1010 * 283 / (273 + air.temperature_c);
    const auto saemundsson = [](double degrees) { return 1.02 / 60 / std::tan((degrees + 10.3 / (degrees + 5.11)) * degree); };
    // Below the horizon nothing is seen that could be lifted: it fades as in NOAA's solar calculator, by the cotangent.
    constexpr double horizon_deg = -0.575;
    const double degrees = elevation_true_rad / degree;
    const double lift = degrees >= horizon_deg ? saemundsson(degrees)
                                               : saemundsson(horizon_deg) * std::tan(horizon_deg * degree) / std::tan(degrees * degree);
    return std::max(lift, 0.0) * density * degree;
}

SunPosition sun_position(const Place& place, double unix_s, const Air& air) {
    const glm::dvec3 enu = local_sun_m(place, unix_s);
    SunPosition sun;
    sun.elevation_true_rad = true_elevation(enu);
    sun.elevation_rad = sun.elevation_true_rad + refraction_rad(sun.elevation_true_rad, air);
    const double azimuth = std::atan2(enu.x, enu.y);
    sun.azimuth_rad = azimuth < 0 ? azimuth + 2 * pi : azimuth;
    sun.distance_au = glm::length(enu) / ERFA_DAU;
    return sun;
}

SunDay sun_day(const Place& place, const CivilTime& time) {
    SunDay day;
    day.solar_noon = start_of_day(time).unix_s + 0.5 * day_s;
    for (int i = 0; i < 3; ++i) day.solar_noon -= hour_angle(place, day.solar_noon) * day_s / (2 * pi);
    const auto up = [&](double t) { return true_elevation(local_sun_m(place, t)) >= rising_elevation; };
    const double before = day.solar_noon - 0.5 * day_s, after = day.solar_noon + 0.5 * day_s;
    if (!up(day.solar_noon)) {
        day.state = SunState::polar_night;
        return day;
    }
    if (!up(before)) day.sunrise = crossing(place, before, day.solar_noon);
    if (!up(after)) day.sunset = crossing(place, after, day.solar_noon);
    if (!day.sunrise && !day.sunset) day.state = SunState::polar_day;
    return day;
}

}  // namespace heliodon
