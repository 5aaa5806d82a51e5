// Twilight: illuminances as measured, colours by what air scatters once, and no step at its ends.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "daylight_skies.h"
#include "shading/cie_sky.h"
#include "shading/colour_matching.h"
#include "shading/quadrature.h"
#include "shading/sky.h"
#include "shading/solar_bands.h"

namespace heliodon::shading {
namespace {

TEST(Twilight, HasTheMeasuredIlluminancesFromCivilDuskOn) {
    // Seidelmann 1992, Explanatory Supplement to the Astronomical Almanac, after Janiczek & DeYoung: civil, nautical,
    // astronomical dusk.
    const std::pair<double, double> table[] = {{-6, 3.41}, {-12, 8.0e-3}, {-18, 6.5e-4}};
    for (const auto& [elevation, lux] : table) {
        EXPECT_NEAR(twilight_illuminance(elevation * degree), lux, 0.02 * lux);
        for (const std::uint32_t model : models) EXPECT_NEAR(horizontal_illuminance(sky_of(model, 3, elevation)), lux, 0.02 * lux) << model;
    }
    EXPECT_EQ(twilight_illuminance(-90 * degree), twilight_illuminance(-18 * degree));
}

TEST(Twilight, FallsSteadilyAndWithoutAStep) {
    for (const std::uint32_t model : models) {
        double before = 1e9;
        for (double elevation = 0; elevation >= -20; elevation -= 0.2) {
            const double lux = horizontal_illuminance(sky_of(model, 3, elevation));
            ASSERT_LE(lux, before * 1.0001) << elevation;
            EXPECT_TRUE(before == 1e9 || lux > 0.69 * before) << model << " " << elevation << ": a fifth of a degree";
            before = lux;
        }
        // Where the formula goes over to twilight each direction's luminance does: in steps of 10⁻⁶ degrees.
        const SkyData above = sky_of(model, 3, 1e-6), below = sky_of(model, 3, -1e-6);
        for (double elevation = 1; elevation <= 90; elevation += 8)
            for (double azimuth = 0; azimuth < 360; azimuth += 30) {
                const double a = nits(radiance(above, azimuth, elevation)), b = nits(radiance(below, azimuth, elevation));
                EXPECT_NEAR(a, b, 0.02 * a) << model << ' ' << elevation << ' ' << azimuth;
            }
    }
}

glm::dvec2 chromaticity(const glm::dvec3& xyz) {
    return glm::dvec2(xyz) / (xyz.x + xyz.y + xyz.z);
}
/// Of level ground's light.
glm::dvec2 chromaticity_of(const SkyData& sky) {
    const glm::dvec3 rgb = horizontal_illuminance_rgb(sky);
    return chromaticity(inverse(glm::dmat3(rgb_from_xyz(vec3(1, 0, 0)), rgb_from_xyz(vec3(0, 1, 0)), rgb_from_xyz(vec3(0, 0, 1)))) * rgb);
}

/// Columns of air, aerosols and ozone along a ray, in those from the ground to the zenith.
struct Columns {
    double air = 0, aerosols = 0, ozone = 0;
    void add(double altitude_km, double way_km) {
        air += way_km / 8 * std::exp(-altitude_km / 8);
        aerosols += way_km / 1.2 * std::exp(-altitude_km / 1.2);
        ozone += way_km / 15 * std::max(1 - std::abs(altitude_km - 25) / 15, 0.0);  // a layer from 10 to 40 km
    }
};
constexpr double earth_km = 6371, top_km = earth_km + 80;

/// From `point` (km from the Earth's middle) along the unit `direction` to space; false where the ground is in the way.
bool columns_to_space(const glm::dvec3& point, const glm::dvec3& direction, Columns& columns) {
    const double along = dot(point, direction), nearest2 = dot(point, point) - along * along;
    if (along < 0 && nearest2 < earth_km * earth_km) return false;
    const double length = -along + std::sqrt(along * along + top_km * top_km - dot(point, point));
    constexpr int steps = 300;
    for (int i = 0; i < steps; ++i) columns.add(glm::length(point + direction * (length * (i + 0.5) / steps)) - earth_km, length / steps);
    return true;
}

TEST(Twilight, HasAtCivilDuskTheColourOfSunlightThatAirScattersOnce) {
    static const GaussLegendre<8> rule;
    constexpr double turbidity = 3;
    const glm::dvec3 sun(std::cos(-6 * degree), std::sin(-6 * degree), 0), ground(0, earth_km, 0);
    std::array<double, 38> level{};
    for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t j = 0; j < 8; ++j) {
            const double sine = rule.x[i], cosine = std::sqrt(1 - sine * sine), azimuth = std::numbers::pi * rule.x[j];
            const glm::dvec3 view(cosine * std::cos(azimuth), sine, cosine * std::sin(azimuth));
            const double length = -earth_km * sine + std::sqrt(earth_km * earth_km * (sine * sine - 1) + top_km * top_km);
            const double phase = 1 + std::pow(dot(view, sun), 2);  // Rayleigh's
            Columns to_ground;
            constexpr int steps = 100;
            for (int k = 0; k < steps; ++k) {
                const double share = (k + 0.5) / steps, way = 1.5 * std::sqrt(share) * length / steps;
                const glm::dvec3 point = ground + view * (length * std::pow(share, 1.5));
                const double altitude = glm::length(point) - earth_km;
                to_ground.add(altitude, way);
                Columns whole = to_ground;
                if (!columns_to_space(point, sun, whole)) continue;
                const double scattering = rule.weight[i] * rule.weight[j] * sine * phase * way * std::exp(-altitude / 8);
                for (std::size_t band = 0; band < 38; ++band) {
                    const double micrometre = 0.38 + 0.01 * static_cast<double>(band), air = air_depth(micrometre);
                    level[band] += scattering * air * solar_bands[band].sun *
                                   std::exp(-air * whole.air - aerosol_depth(micrometre, turbidity) * whole.aerosols -
                                            solar_bands[band].ozone * ozone_cm * whole.ozone);
                }
            }
        }
    glm::dvec3 xyz(0);
    for (std::size_t band = 0; band < 38; ++band) {
        const ColourMatching& match = colour_matching[2 * band];
        xyz += level[band] * glm::dvec3(match.x, match.y, match.z);
    }
    EXPECT_NEAR(chromaticity(xyz).x, civil_dusk_x, 0.003);
    EXPECT_NEAR(chromaticity(xyz).y, civil_dusk_y, 0.003);
    for (const std::uint32_t model : models) {
        EXPECT_LT(distance(chromaticity_of(sky_of(model, turbidity, -6)), glm::dvec2(civil_dusk_x, civil_dusk_y)), 0.002) << model;
        EXPECT_LT(distance(chromaticity_of(sky_of(model, turbidity, -18)), glm::dvec2(0.3127, 0.3290)), 0.0005) << "white";
    }
}

TEST(Twilight, ChangesItsColourSmoothly) {
    for (const std::uint32_t model : models)
        for (double elevation = 0; elevation > -18; elevation -= 0.1) {
            const glm::dvec2 here = chromaticity_of(sky_of(model, 3, elevation)), next = chromaticity_of(sky_of(model, 3, elevation - 0.1));
            ASSERT_LT(distance(here, next), 0.0025) << model << ' ' << elevation;
            ASSERT_TRUE(elevation < -5.9 || next.x < here.x) << "bluer: " << model << ' ' << elevation;
        }
}

}  // namespace
}  // namespace heliodon::shading
