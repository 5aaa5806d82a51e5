#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "shading/daylight.h"

namespace heliodon::shading {
namespace {

constexpr std::size_t turbidities = 10, controls = 6, terms = 9;
constexpr std::size_t table_size = 2 * turbidities * controls;

/// Of X, Y and Z: terms and then what they are relative to; by albedo, turbidity and control point.
struct Tables {
    struct {
        double terms[table_size * shading::terms], radiance[table_size];
    } of[3];
};
constexpr Tables tables = {
#include "sky/hosek-wilkie-xyz.csv"
};

/// Quintic Bézier curve over control points `stride` apart.
double bezier(const double* points, std::size_t stride, double t) {
    constexpr double binomial[controls] = {1, 5, 10, 10, 5, 1};
    double sum = 0;
    for (std::size_t i = 0; i < controls; ++i)
        sum += binomial[i] * std::pow(1 - t, 5.0 - static_cast<double>(i)) * std::pow(t, static_cast<double>(i)) * points[i * stride];
    return sum;
}

}  // namespace

DaylightCoefficients hosek_coefficients(double turbidity, double ground_albedo, double sun_elevation) {
    // Linear in turbidity and albedo.
    const double t = std::cbrt(std::clamp(sun_elevation / (0.5 * std::numbers::pi), 0.0, 1.0));
    const double place = std::clamp(turbidity, 1.0, double(turbidities)) - 1;
    const auto low = std::min(static_cast<std::size_t>(place), turbidities - 2);
    const double part = place - static_cast<double>(low);
    constexpr double lumen_per_watt = 683;
    DaylightCoefficients result{};
    for (int channel = 0; channel < 3; ++channel) {
        double mean = 0;
        std::array<double, terms> sums{};
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const double weight = (corner & 1 ? part : 1 - part) * (corner & 2 ? ground_albedo : 1 - ground_albedo);
            const std::size_t first = ((corner >> 1) * turbidities + low + (corner & 1)) * controls;
            mean += weight * bezier(tables.of[channel].radiance + first, 1, t);
            for (std::size_t i = 0; i < terms; ++i) sums[i] += weight * bezier(tables.of[channel].terms + first * terms + i, terms, t);
        }
        for (std::size_t i = 0; i < terms; ++i) {
            const bool additive = i == 2 || i == 3 || i == 5 || i == 6 || i == 7;
            result[i][channel] = additive ? sums[i] * mean * lumen_per_watt : sums[i];
        }
    }
    return result;
}

}  // namespace heliodon::shading
