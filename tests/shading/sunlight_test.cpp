// The sun's own light: by the authors of the Hošek-Wilkie model, by Preetham's atmosphere, and as its disc sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "daylight_skies.h"
#include "shading/cie_sky.h"
#include "shading/light.h"

namespace heliodon::shading {
namespace {

double normal_lux(std::uint32_t model, double turbidity, double elevation_deg) {
    return units::luminance(sunlight(model, turbidity, elevation_deg * degree, diameter).normal());
}
double hosek_lux(double turbidity, double elevation) {
    return hosek_sun_xyz(turbidity, elevation).y;
}

TEST(HosekSun, IsThatOfTheAuthorsCode) {
    // Direct normal lux at a turbidity of 3.
    const std::pair<double, double> table[] = {{10, 41049}, {30, 69991}, {60, 79682}};
    for (const auto& [elevation, lux] : table) EXPECT_NEAR(normal_lux(sky_model_hosek, 3, elevation), lux, 0.001 * lux) << elevation;
}

TEST(HosekSun, DoesNotJumpBetweenItsPiecesNorAtWholeTurbidities) {
    for (int turbidity = 1; turbidity <= 10; ++turbidity) {
        for (int piece = 1; piece < 45; ++piece) {
            const double border = 90 * degree * std::pow(piece / 45.0, 3), step = 1e-5 * border;
            const auto at = [&](double steps) { return hosek_lux(turbidity, border + steps * step); };
            const double slope = (at(0) - at(-1)) / step, scale = std::max(at(0), 1.0);
            EXPECT_NEAR(at(-1e-6), at(1e-6), 1e-6 * scale) << turbidity << ' ' << piece;
            EXPECT_NEAR((at(1) - at(0)) / step, slope, 1e-3 * std::max(std::abs(slope), scale)) << turbidity << ' ' << piece;
        }
        for (const double elevation : {0.0, 0.01, 0.2, 1.0, 1.57})
            EXPECT_NEAR(hosek_lux(turbidity - 1e-9, elevation), hosek_lux(turbidity + 1e-9, elevation), 1e-3) << turbidity;
    }
}

TEST(HosekSun, RisesWithElevationAndSinksWithTurbidity) {
    for (double turbidity = 1; turbidity <= 10; turbidity += 0.25)
        for (double elevation = 0.01; elevation < 90; elevation *= 1.1) {
            const double lux = hosek_lux(turbidity, elevation * degree);
            ASSERT_GE(lux, 0);
            ASSERT_LE(lux, hosek_lux(turbidity, 1.1 * elevation * degree) + 1e-9) << turbidity << ' ' << elevation;
            ASSERT_GE(lux, hosek_lux(turbidity + 0.25, elevation * degree)) << turbidity << ' ' << elevation;
        }
    const glm::dvec3 low = sunlight(sky_model_hosek, 3, 5 * degree, diameter).normal(), high = sunlight(sky_model_hosek, 3, 60 * degree, diameter).normal();
    EXPECT_GT(low.r / low.b, 2 * high.r / high.b) << "a low sun is red";
}

TEST(PreethamSun, IsThatOfAStandardAtmosphere) {
    // ASTM G173-03: 97.1 klx direct normal at an air mass of 1.5 with 0.084 of aerosols at 500 nm, which is a turbidity of
    // (β + 0.04586) / 0.04608 with β = 0.084 · 0.5^1.3.
    const double turbidity = (0.084 * std::pow(0.5, 1.3) + 0.04586) / 0.04608;
    EXPECT_NEAR(normal_lux(sky_model_preetham, turbidity, 41.81), 97100, 0.02 * 97100);
}

TEST(Sunlight, FallsToNothingAsTheDiscSetsWithoutAStep) {
    for (const std::uint32_t model : models) {
        double before = 1e9;
        for (double elevation = 90; elevation > -0.3; elevation -= 0.01) {
            const double lux = normal_lux(model, 3, elevation);
            ASSERT_LE(lux, before * 1.000001) << elevation;
            EXPECT_TRUE(before == 1e9 || before - lux < 0.03 * before + 20) << model << ' ' << elevation;
            before = lux;
        }
        EXPECT_GT(normal_lux(model, 3, 0), 0) << "half of the disc";
        EXPECT_EQ(normal_lux(model, 3, -0.27), 0);
        EXPECT_GT(units::luminance(sunlight(model, 3, -0.1 * degree, diameter).level()), 0) << "what is above still lights the ground";
        EXPECT_GT(units::luminance(sunlight(model, 3, 0, 0).normal()), 0) << "a point";
        EXPECT_EQ(units::luminance(sunlight(model, 3, -1e-9, 0).normal()), 0);
    }
}

TEST(DiscAbove, HasTheShareAndTheMiddleOfItsLuminance) {
    constexpr int cells = 1000;
    for (const double height : {-0.9, -0.4, 0.0, 0.3, 0.8}) {
        double all = 0, light = 0, moment = 0;
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < cells; ++j) {
                const double x = 2 * (i + 0.5) / cells - 1, y = 2 * (j + 0.5) / cells - 1;
                if (x * x + y * y > 1) continue;
                const double luminance = limb_darkening(static_cast<float>(x * x + y * y));
                all += luminance;
                if (height + y < 0) continue;
                light += luminance;
                moment += luminance * (height + y);
            }
        const DiscAbove above = disc_above(height * 0.005, 0.005);
        EXPECT_NEAR(above.share, light / all, 2e-3) << height;
        EXPECT_NEAR(above.elevation, 0.005 * moment / light, 2e-5) << height;
    }
    EXPECT_NEAR(disc_above(0.00499999, 0.005).share, 1, 1e-5);
    EXPECT_NEAR(disc_above(0.00499999, 0.005).elevation, 0.005, 1e-7);
    EXPECT_NEAR(disc_above(-0.00499999, 0.005).share, 0, 1e-5);
}

TEST(HosekSun, WithItsSkyDeviatesFromPublishedClearSkiesAsDocumented) {
    // IES Calculation Procedures Committee 1984, "Recommended Practice for the Calculation of Daylight Availability": clear
    // sky, klx: 127.5 e^(−0.21 m) sin a + 0.8 + 15.5 √sin a, with the air mass m = 1/sin a.
    const std::pair<double, double> rows[] = {{10, 0.18}, {20, 0.0}, {30, -0.07}, {45, -0.12}, {60, -0.15}, {90, -0.15}};
    for (const auto& [elevation, deviation] : rows) {
        const double sine = std::sin(elevation * degree), published = 127500 * std::exp(-0.21 / sine) * sine + 800 + 15500 * std::sqrt(sine);
        const double here = horizontal_illuminance(sky_of(sky_model_hosek, 3, elevation)) +
                            units::luminance(sunlight(sky_model_hosek, 3, elevation * degree, diameter).level());
        EXPECT_NEAR(here / published - 1, deviation, 0.01) << elevation;
    }
}

TEST(SunsDisc, DarkensToItsLimbAndKeepsItsIlluminance) {
    LightData sun{};
    sun.type = light_type_directional;
    sun.axis = vec3(0, 0, -1);
    sun.radius = static_cast<float>(0.5 * diameter);
    sun.intensity = vec3(80000);
    sun.opening = opening_sun;
    const auto at = [&](double share) {
        const double angle = share * sun.radius;
        return double(light_radiance(sun, vec3(std::sin(angle), 0, std::cos(angle))).x);
    };
    EXPECT_NEAR(at(0.999) / at(0), 0.268 + 1.343 * std::sqrt(1 - 0.999 * 0.999), 0.01) << "Neckel & Labs 1994";
    EXPECT_LT(at(0.95), 0.72 * at(0));
    double lux = 0;
    constexpr int rings = 4000;
    for (int i = 0; i < rings; ++i) {
        const double share = (i + 0.5) / rings, angle = share * sun.radius;
        lux += at(share) * 2 * std::numbers::pi * std::sin(angle) * std::cos(angle) * sun.radius / rings;
    }
    EXPECT_NEAR(lux, 80000, 80);
    EXPECT_EQ(light_radiance(sun, normalize(vec3(0.001f, -1e-6f, 1))).x, 0) << "behind the ground";
    const double solid_angle = 2 * std::numbers::pi * (1 - std::cos(0.5 * diameter));
    sun.opening = 0;
    EXPECT_NEAR(at(0.3) * solid_angle, 80000, 80) << "other discs are even";
}

}  // namespace
}  // namespace heliodon::shading
