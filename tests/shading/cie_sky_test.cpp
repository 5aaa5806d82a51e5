// ISO 15469:2004 (CIE S 011): luminances relative to the zenith and horizontal illuminances by published tables.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "shading/cie_sky.h"
#include "shading/sky.h"

namespace heliodon::shading {
namespace {

constexpr float degree = pi / 180.0f;

SkyData sky_of(int type, float zenith = 1, float sun_elevation_deg = 60, float albedo = 0.2f) {
    SkyData sky{};
    set_cie_sky(type, zenith, albedo, 0, sun_elevation_deg * degree, sky);
    return sky;
}

double relative_luminance(const SkyData& sky, float zenith_angle_deg, float azimuth_deg) {
    return sky_radiance(sky, direction_from_azimuth(azimuth_deg * degree, (90 - zenith_angle_deg) * degree, 0), vec3(1)).x;
}

TEST(CieSky, HorizontalIlluminancesOfAllTypesAreTheTablesWithTheSunAtSixtyDegrees) {
    const std::pair<int, double> table[] = {{1, 2.4495}, {2, 2.0860},  {3, 2.7700},  {5, 3.1416}, {6, 2.5842},
                                            {9, 3.4593}, {10, 3.1703}, {12, 3.1906}, {14, 3.2170}};
    for (const auto& [type, expected] : table)
        EXPECT_NEAR(horizontal_illuminance(sky_of(type)), expected, 1e-4 * expected) << type;
    EXPECT_NEAR(horizontal_illuminance(sky_of(16, 900)), 900 * 7 * std::numbers::pi / 9, 0.01) << "Moon & Spencer";
}

TEST(CieSky, LuminancesOfAnOvercastAndAClearSkyAreTheTables) {
    const SkyData overcast = sky_of(1), clear = sky_of(12);
    const double expected[2][3] = {{.93173, .66516, .33529}, {3.85246, .69473, 1.73277}};
    const std::pair<float, float> places[] = {{30, 0}, {60, 90}, {85, 0}};
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(relative_luminance(overcast, places[i].first, places[i].second), expected[0][i], 1e-5);
        EXPECT_NEAR(relative_luminance(clear, places[i].first, places[i].second), expected[1][i], 5e-5);
    }
    EXPECT_NEAR(relative_luminance(clear, 0, 0), 1, 1e-5) << "the zenith";
}

TEST(CieSky, TheTraditionalOvercastSkyGivesWallsTwoFifthsOfTheGround) {
    // .396177 of the horizontal illuminance: of the sky alone, over black ground.
    const SkyData sky = sky_of(16, 1, 60, 0);
    double sum = 0;
    constexpr int steps = 400;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double sine = (i + 0.5) / steps, azimuth = std::numbers::pi * ((j + 0.5) / steps - 0.5);
            const double cosine = std::sqrt(1 - sine * sine);
            const vec3 direction(cosine * std::cos(azimuth), sine, cosine * std::sin(azimuth));
            sum += sky_radiance(sky, direction, vec3(1)).x * direction.x;
        }
    EXPECT_NEAR(sum * std::numbers::pi / (steps * steps) / horizontal_illuminance(sky), .396177, 2e-5);
}

TEST(CieSky, EveryTypeIsBrightAndItsGroundIsLitByIt) {
    for (int type = 1; type <= 16; ++type)
        for (const float sun : {0.0f, 30.0f, 90.0f}) {
            const SkyData sky = sky_of(type, 5000, sun, 0.3f);
            for (float zenith_angle = 0; zenith_angle <= 90; zenith_angle += 5)
                for (float azimuth = 0; azimuth < 360; azimuth += 15)
                    ASSERT_GT(relative_luminance(sky, zenith_angle, azimuth), 0) << type << ' ' << zenith_angle;
            EXPECT_NEAR(relative_luminance(sky, 120, 40), 0.3 * horizontal_illuminance(sky) / std::numbers::pi, 0.5) << type;
        }
}

TEST(CieSky, TheSunStandsWhereAzimuthAndNorthSay) {
    SkyData sky{};
    sky.north_rad = 20 * degree;
    set_cie_sky(12, 1, 0, 70 * degree, 40 * degree, sky);
    const vec3 sun = direction_from_azimuth(90 * degree, 40 * degree, 0);
    EXPECT_LT(length(sky.sun_direction - sun), 1e-6f);
    const float at_sun = sky_radiance(sky, sun, vec3(1)).x;
    for (const float aside : {-5.0f, 5.0f})
        EXPECT_GT(at_sun, sky_radiance(sky, direction_from_azimuth((90 + aside) * degree, 40 * degree, 0), vec3(1)).x);
}

}  // namespace
}  // namespace heliodon::shading
