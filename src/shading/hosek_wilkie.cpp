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

/// The authors' sun, by turbidity and elevation: values in lux and slopes in lux per radian.
constexpr std::size_t sun_pieces = 45;
struct SunNode {
    double x, x_slope, y, y_slope, z, z_slope;
};
constexpr SunNode sun_nodes[turbidities][sun_pieces + 1] = {
#include "sky/hosek-wilkie-sun-xyz.csv"
};

/// Between tables of whole turbidities.
struct BetweenTurbidities {
    std::size_t low;
    double part;  ///< of low + 1
};
BetweenTurbidities between_turbidities(double turbidity) {
    const double place = std::clamp(turbidity, 1.0, double(turbidities)) - 1;
    const auto low = std::min(static_cast<std::size_t>(place), turbidities - 2);
    return {low, place - static_cast<double>(low)};
}

/// Weights of a quintic Bézier curve's control points.
std::array<double, controls> bezier_weights(double t) {
    constexpr std::array<double, controls> binomial{1, 5, 10, 10, 5, 1};
    std::array<double, controls> weights{};
    for (std::size_t i = 0; i < controls; ++i) weights[i] = binomial[i] * std::pow(1 - t, 5.0 - double(i)) * std::pow(t, double(i));
    return weights;
}

/// The cubic with these values and slopes at both ends of `length`.
double hermite(double from, double from_slope, double to, double to_slope, double length, double t) {
    const double a = from_slope * length, b = to_slope * length, rise = to - from;
    return from + t * (a + t * (3 * rise - 2 * a - b + t * (a + b - 2 * rise)));
}

glm::dvec3 sun_of_turbidity(const SunNode (&nodes)[sun_pieces + 1], double elevation) {
    const auto begin = [](std::size_t piece) { return 0.5 * std::numbers::pi * std::pow(double(piece) / sun_pieces, 3.0); };
    const double place = sun_pieces * std::cbrt(elevation / (0.5 * std::numbers::pi));
    const std::size_t piece = std::min(static_cast<std::size_t>(place), sun_pieces - 1);
    const double length = begin(piece + 1) - begin(piece), t = (elevation - begin(piece)) / length;
    const SunNode &a = nodes[piece], &b = nodes[piece + 1];
    return {hermite(a.x, a.x_slope, b.x, b.x_slope, length, t), hermite(a.y, a.y_slope, b.y, b.y_slope, length, t),
            hermite(a.z, a.z_slope, b.z, b.z_slope, length, t)};
}

}  // namespace

DaylightCoefficients hosek_coefficients(double turbidity, double ground_albedo, double sun_elevation) {
    // Linear in turbidity and albedo.
    const double t = std::cbrt(std::clamp(sun_elevation / (0.5 * std::numbers::pi), 0.0, 1.0));
    const auto [low, part] = between_turbidities(turbidity);
    const std::array<double, controls> along = bezier_weights(t);
    constexpr double lumen_per_watt = 683;
    DaylightCoefficients result{};
    for (int channel = 0; channel < 3; ++channel) {
        double mean = 0;
        std::array<double, terms> sums{};
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const double of_corner = (corner & 1 ? part : 1 - part) * (corner & 2 ? ground_albedo : 1 - ground_albedo);
            const std::size_t first = ((corner >> 1) * turbidities + low + (corner & 1)) * controls;
            for (std::size_t point = 0; point < controls; ++point) {
                const double weight = of_corner * along[point];
                mean += weight * tables.of[channel].radiance[first + point];
                for (std::size_t i = 0; i < terms; ++i) sums[i] += weight * tables.of[channel].terms[(first + point) * terms + i];
            }
        }
        for (std::size_t i = 0; i < terms; ++i) {
            const bool additive = i == 2 || i == 3 || i == 5 || i == 6 || i == 7;
            result[i][channel] = additive ? sums[i] * mean * lumen_per_watt : sums[i];
        }
    }
    return result;
}

glm::dvec3 hosek_sun_xyz(double turbidity, double elevation) {
    const auto [low, part] = between_turbidities(turbidity);
    const double above = std::clamp(elevation, 0.0, 0.5 * std::numbers::pi);
    return glm::max(glm::mix(sun_of_turbidity(sun_nodes[low], above), sun_of_turbidity(sun_nodes[low + 1], above), part), 0.0);
}

}  // namespace heliodon::shading
