#include <cmath>
#include <numbers>

#include "shading/daylight.h"

namespace heliodon::shading {
namespace {

struct Perez {
    double a, b, c, d, e;
    [[nodiscard]] double value(double cos_zenith_angle, double from_sun) const {
        const double cosine = std::cos(from_sun);
        return (1 + a * std::exp(b / cos_zenith_angle)) * (1 + c * std::exp(d * from_sun) + e * cosine * cosine);
    }
};

/// Chromaticity of the zenith: table rows by powers 3 to 0 of the sun's zenith angle, columns T², T, 1.
double zenith_chromaticity(const double (&table)[3][4], double turbidity, double zenith_angle) {
    double sum = 0;
    for (const auto& row : table) sum = sum * turbidity + (((row[0] * zenith_angle + row[1]) * zenith_angle + row[2]) * zenith_angle + row[3]);
    return sum;
}
constexpr double zenith_x[3][4] = {{0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}};
constexpr double zenith_y[3][4] = {{0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}};

}  // namespace

DaylightCoefficients preetham_coefficients(double turbidity, double sun_elevation) {
    const double t = turbidity, zenith_angle = 0.5 * std::numbers::pi - sun_elevation;
    const Perez perez[3] = {{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703},
                            {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452},
                            {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529}};
    const double chi = (4.0 / 9 - t / 120) * (std::numbers::pi - 2 * zenith_angle);
    const double zenith_kcd = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
    const double zenith[3] = {1000 * zenith_kcd, zenith_chromaticity(zenith_x, t, zenith_angle), zenith_chromaticity(zenith_y, t, zenith_angle)};
    DaylightCoefficients result{};
    for (int i = 0; i < 3; ++i) {
        const Perez& p = perez[i];
        const double scale = zenith[i] / p.value(1, zenith_angle);
        const double terms[9] = {p.a, p.b, scale, scale * p.c, p.d, scale * p.e, 0, 0, 0};
        for (std::size_t term = 0; term < 9; ++term) result[term][i] = terms[term];
    }
    return result;
}

}  // namespace heliodon::shading
