// The sun against the worked example of Reda & Andreas 2003 and JPL Horizons.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/math.h"
#include "scene/sun_position.h"

namespace heliodon {
namespace {

constexpr double degree = std::numbers::pi / 180;

double seconds(const char* text) {
    const auto time = parse_civil_time(text);
    EXPECT_TRUE(time) << text;
    return time ? time->unix_s : 0;
}
Place place_deg(double latitude, double longitude, double altitude_m = 0) {
    return {latitude * degree, longitude * degree, altitude_m};
}
const Place spa_place = place_deg(39.742476, -105.1786, 1830.14);

TEST(SunPosition, IsThatOfTheWorkedExampleOfTheSolarPositionAlgorithm) {
    const SunPosition sun = sun_position(spa_place, seconds("2003-10-17T12:30:30-07:00"), {820, 11});
    EXPECT_NEAR(90 - sun.elevation_rad / degree, 50.111622, 0.001);
    EXPECT_NEAR(sun.azimuth_rad / degree, 194.340241, 0.001);
}

TEST(SunPosition, IsThatOfJplHorizons) {
    const struct {
        const char* time;
        double latitude, longitude, azimuth, elevation;
    } rows[] = {{"2026-06-21T00:00Z", 78.22334, 15.64689, 14.258502, 12.118881},   {"2026-07-06T12:00Z", 59.32938, 18.06871, 205.437817, 51.435969},
                {"2026-06-21T06:00Z", 31.22222, 121.45806, 261.881800, 61.481435}, {"2026-03-20T18:00Z", 4.60971, -74.08175, 252.428624, 75.221851},
                {"2026-06-21T18:00Z", -34.61315, -58.37723, 328.459121, 24.885283}, {"2026-12-21T00:00Z", -77.846, 166.676, 14.388365, 35.273973}};
    for (const auto& row : rows) {
        const SunPosition sun = sun_position(place_deg(row.latitude, row.longitude), seconds(row.time));
        EXPECT_NEAR(sun.azimuth_rad / degree, row.azimuth, 0.01) << row.time;
        EXPECT_NEAR(sun.elevation_rad / degree, row.elevation, 0.01) << row.time;
    }
}

TEST(SunPosition, RisesAndSetsWhenTheAlgorithmsExampleDoes) {
    const SunDay day = sun_day(spa_place, *parse_civil_time("2003-10-17T12:30:30-07:00"));
    ASSERT_TRUE(day.sunrise && day.sunset);
    EXPECT_EQ(day.state, SunState::rises_and_sets);
    EXPECT_NEAR(*day.sunrise, seconds("2003-10-17T06:12:43-07:00"), 5);
    // The algorithm works in days of UT: the sunset it prints, 17:20:19, is of 2003-10-17 UT and so of the evening before.
    const SunDay before = sun_day(spa_place, *parse_civil_time("2003-10-16T12:30:30-07:00"));
    ASSERT_TRUE(before.sunset);
    EXPECT_NEAR(*before.sunset, seconds("2003-10-16T17:20:19-07:00"), 5);
    EXPECT_NEAR(*day.sunset, *before.sunset + 86400 - 87, 5) << "days grow shorter";
    EXPECT_NEAR(std::remainder(sun_position(spa_place, day.solar_noon).azimuth_rad / degree - 180, 360), 0, 0.001);
}

TEST(SunPosition, PolarDayAndNightHaveNoRisingAndNoSetting) {
    const Place longyearbyen = place_deg(78.22334, 15.64689);
    const SunDay summer = sun_day(longyearbyen, *parse_civil_time("2026-06-21T12:00:00+02:00"));
    EXPECT_EQ(summer.state, SunState::polar_day);
    EXPECT_FALSE(summer.sunrise || summer.sunset);
    const SunDay winter = sun_day(longyearbyen, *parse_civil_time("2026-12-21T12:00:00+01:00"));
    EXPECT_EQ(winter.state, SunState::polar_night);
    EXPECT_FALSE(winter.sunrise || winter.sunset);
    EXPECT_EQ(sun_day(longyearbyen, *parse_civil_time("2026-03-21T12:00:00+01:00")).state, SunState::rises_and_sets);
    EXPECT_EQ(sun_day(place_deg(-90, 0), *parse_civil_time("2026-12-21T12:00:00Z")).state, SunState::polar_day);
    EXPECT_EQ(sun_day(place_deg(90, 0), *parse_civil_time("2026-12-21T12:00:00Z")).state, SunState::polar_night);
}

TEST(SunPosition, SolarNoonFallsIntoTheClocksDayWhateverItsOffset) {
    for (const double longitude : {-179.0, -75.0, 0.0, 139.7, 179.0})
        for (const char* time : {"2026-01-15T00:00:00-11:00", "2026-01-15T23:59:59Z", "2026-01-15T12:00:00+14:00"}) {
            const CivilTime clock = *parse_civil_time(time);
            const Place place = place_deg(35, longitude);
            const SunDay day = sun_day(place, clock);
            const double within = day.solar_noon - start_of_day(clock).unix_s;
            EXPECT_TRUE(within > -60 && within < 86460) << longitude << ' ' << time << ' ' << within;
            ASSERT_TRUE(day.sunrise && day.sunset);
            EXPECT_LT(*day.sunrise, day.solar_noon);
            EXPECT_GT(*day.sunset, day.solar_noon);
            for (const double event : {*day.sunrise, *day.sunset}) EXPECT_NEAR(sun_position(place, event).elevation_true_rad / degree, -50.0 / 60, 0.001);
        }
}

TEST(SunPosition, RefractionIsSmoothAndLiftsTheSettingSunByHalfADegree) {
    EXPECT_NEAR(refraction_rad(0) / degree * 60, 28.7, 0.6) << "minutes of arc";
    EXPECT_NEAR(refraction_rad(45 * degree) / degree * 60, 1.0, 0.03);
    for (double elevation = -90; elevation < 90; elevation += 0.05) {
        const double lift = refraction_rad(elevation * degree), next = refraction_rad((elevation + 0.05) * degree);
        ASSERT_TRUE(std::isfinite(lift) && lift >= 0);
        EXPECT_LT(std::abs(next - lift) / degree, 0.05) << elevation << ": what stands higher appears higher";
    }
}

TEST(SunPosition, IsDefinedEverywhereAtAnyTimeOfTwoHundredYears) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    const double first = seconds("1900-01-01T00:00:00Z"), last = seconds("2100-12-31T23:59:59Z");
    for (int i = 0; i < 300; ++i) {
        const Place place = place_deg(i % 10 == 0 ? 90.0 * (i % 20 == 0 ? 1 : -1) : 180 * unit(random) - 90, 360 * unit(random) - 180);
        const SunPosition sun = sun_position(place, std::lerp(first, last, i == 0 ? 0.0 : unit(random)));
        ASSERT_TRUE(sun.azimuth_rad >= 0 && sun.azimuth_rad <= 2 * std::numbers::pi);
        ASSERT_TRUE(std::abs(sun.elevation_rad) <= std::numbers::pi / 2);
        EXPECT_NEAR(sun.distance_au, 1, 0.0171);
    }
    // The equation of time has no step where the count of leap seconds begins.
    const Place greenwich = place_deg(51.4779, 0);
    const double before = sun_position(greenwich, seconds("1959-12-31T23:59:59Z")).azimuth_rad, after = sun_position(greenwich, seconds("1960-01-01T00:00:00Z")).azimuth_rad;
    EXPECT_NEAR(std::remainder(after - before, 2 * std::numbers::pi) / degree, 1.0 / 240, 0.01);
}

}  // namespace
}  // namespace heliodon
