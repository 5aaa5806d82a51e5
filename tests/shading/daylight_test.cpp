// Daylight by Hošek & Wilkie and by Preetham against figures of the authors' own code.
#include "shading/daylight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "daylight_skies.h"
#include "shading/cie_sky.h"
#include "shading/quadrature.h"
#include "shading/sky.h"

namespace heliodon::shading {
namespace {

TEST(HosekSky, IsThatOfTheAuthorsCode) {
    // X, Y, Z / 683 at a zenith angle and an angle from the sun, which the formula takes for themselves.
    const struct {
        double turbidity, albedo, elevation_deg, zenith_angle_deg, from_sun_deg;
        glm::dvec3 xyz;
    } rows[] = {{2, 0, 45, 0, 45, {3.143451, 3.172077, 7.175605}}, {3, .3, 30, 30, 20, {7.581207, 7.941176, 12.272268}}};
    for (const auto& row : rows) {
        SkyData sky{};
        sky.model = sky_model_hosek;
        sky.horizon = 0.01f;
        const DaylightCoefficients c = hosek_coefficients(row.turbidity, row.albedo, row.elevation_deg * degree);
        for (std::size_t i = 0; i < c.size(); ++i) sky.daylight[i] = vec4(vec3(c[i]), 0);
        sky.daylight[9] = vec4(1);
        const vec3 direction = direction_from_azimuth(0, static_cast<float>((90 - row.zenith_angle_deg) * degree), 0);
        sky.sun_direction = direction_from_azimuth(0, static_cast<float>((90 - row.zenith_angle_deg - row.from_sun_deg) * degree), 0);
        const glm::dvec3 values = glm::dvec3(daylight_values(sky, direction)) / 683.0;
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(values[i], row.xyz[i], 1e-5 * row.xyz[i]) << row.turbidity << ' ' << i;
        EXPECT_NEAR(nits(daylight_radiance(sky, direction)), 683 * row.xyz.y, 1e-4 * 683 * row.xyz.y) << "Y is the luminance";
    }
}

TEST(PreethamSky, HasTheZenithLuminancesOfTheAuthors) {
    EXPECT_NEAR(nits(radiance(sky_of(sky_model_preetham, 2, 45), 0, 90)), 4469.64, 0.001 * 4469.64);
    EXPECT_NEAR(nits(radiance(sky_of(sky_model_preetham, 3, 30), 0, 90)), 5139.16, 0.001 * 5139.16);
}

TEST(DaylightSky, IlluminanceIsTheFinerQuadratures) {
    for (const std::uint32_t model : models)
        for (const double elevation : {0.0, 2.0, 25.0, 60.0, 89.0}) {
            const SkyData sky = sky_of(model, 3, elevation);
            static const GaussLegendre<256> zenith;
            constexpr int azimuths = 2048;
            double sum = 0;
            for (std::size_t i = 0; i < 256; ++i)
                for (int j = 0; j < azimuths; ++j) {
                    const double sine = zenith.x[i], cosine = std::sqrt(1 - sine * sine), a = 2 * std::numbers::pi * (j + 0.5) / azimuths;
                    sum += zenith.weight[i] * sine * nits(sky_radiance(sky, vec3(cosine * std::sin(a), sine, cosine * std::cos(a)), vec3(1)));
                }
            sum *= 2 * std::numbers::pi / azimuths;
            EXPECT_NEAR(horizontal_illuminance(sky), sum, 1e-4 * sum) << model << ' ' << elevation;
        }
}

TEST(DaylightSky, IsFiniteAndShowableEverywhereAtEverySun) {
    for (const std::uint32_t model : models)
        for (const double turbidity : {2.0, 2.5, 6.0, 10.0})
            for (const double sun : {90.0, 45.0, 5.0, 0.0, -0.2, -3.0, -11.0, -18.0, -60.0, -90.0}) {
                const SkyData sky = sky_of(model, turbidity, sun, 1);
                for (double elevation = -90; elevation <= 90; elevation += 7.5)
                    for (double azimuth = 0; azimuth < 360; azimuth += 20) {
                        const vec3 rgb = radiance(sky, azimuth, elevation);
                        ASSERT_TRUE(std::isfinite(rgb.x + rgb.y + rgb.z)) << model << ' ' << turbidity << ' ' << sun << ' ' << elevation;
                        ASSERT_GE(std::min({rgb.x, rgb.y, rgb.z}), 0) << model << ' ' << turbidity << ' ' << sun << ' ' << elevation;
                        ASSERT_GT(nits(rgb), 0) << "dark, never black";
                    }
                const vec3 at_sun = sky_radiance(sky, sky.sun_direction, vec3(1));
                ASSERT_TRUE(std::isfinite(at_sun.x + at_sun.y + at_sun.z) && at_sun.y > 0);
            }
}

TEST(DaylightSky, TheGroundIsLitBySkyAndSun) {
    for (const std::uint32_t model : models) {
        const SkyData sky = sky_of(model, 3, 40, 0.3);
        const glm::dvec3 lux = horizontal_illuminance_rgb(sky) + sunlight(model, 3, 40 * degree, diameter).level();
        const vec3 ground = radiance(sky, 123, -30);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(ground[i], 0.3 * lux[i] / std::numbers::pi, 1e-4 * ground[i]);
    }
}

}  // namespace
}  // namespace heliodon::shading
