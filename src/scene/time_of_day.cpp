#include "scene/time_of_day.h"

#include <algorithm>
#include <cmath>

namespace heliodon {

Sky sky_at(Sky sky, const CivilTime& time) {
    if (!sky.place) return sky;
    const SunPosition sun = sun_position(*sky.place, time.unix_s);
    sky.time = time;
    sky.sun_azimuth_rad = static_cast<float>(sun.azimuth_rad);
    sky.sun_elevation_rad = static_cast<float>(sky.is_daylight() ? sun.elevation_rad : std::max(sun.elevation_rad, 0.0));
    return sky;
}

std::vector<CivilTime> moments_between(const CivilTime& first, const CivilTime& last, std::size_t count) {
    std::vector<CivilTime> moments(count, first);
    for (std::size_t i = 1; i < count; ++i)
        moments[i].unix_s += (last.unix_s - first.unix_s) * static_cast<double>(i) / static_cast<double>(count - 1);
    return moments;
}

std::vector<CivilTime> moments_by_step(const CivilTime& first, const CivilTime& last, double step_s) {
    constexpr double rounding = 1e-6;  // of a step, so that a whole number of steps reaches the end
    const double steps = std::floor((last.unix_s - first.unix_s) / step_s + rounding);
    std::vector<CivilTime> moments;
    for (double i = 0; i <= steps; ++i) moments.push_back({first.unix_s + i * step_s, first.offset_min});
    return moments;
}

}  // namespace heliodon
