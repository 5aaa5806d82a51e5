#include "scene/luminaire.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace heliodon {
namespace {

/// ∫ I(γ) sin γ dγ for the linear I between (a, intensity_a) and (b, intensity_b), over [begin, end] in it.
double linear_times_sine(double a, double b, double intensity_a, double intensity_b, double begin, double end) {
    if (!(end > begin) || !(b > a)) return 0;
    const double slope = (intensity_b - intensity_a) / (b - a);
    const auto intensity = [&](double x) { return intensity_a + slope * (x - a); };
    // By parts: −I cos + slope sin.
    return intensity(begin) * std::cos(begin) - intensity(end) * std::cos(end) + slope * (std::sin(end) - std::sin(begin));
}

}  // namespace

std::string describe(const LuminousOpening& opening) {
    const bool flat = opening.size_m.x <= 0 || opening.size_m.y <= 0 || opening.size_m.z <= 0;
    const auto same = [](float a, float b) { return std::abs(a - b) <= 1e-6f * std::max(a, b); };
    switch (opening.shape) {
        case OpeningShape::point:
            return "point";
        case OpeningShape::box:
            return flat ? "rectangle" : "box";
        case OpeningShape::ellipsoid:
            return same(opening.size_m.x, opening.size_m.y) && same(opening.size_m.y, opening.size_m.z) ? "sphere" : "ellipsoid";
        default:
            return flat ? "disc" : "cylinder";
    }
}

double integrated_flux_lm(const PhotometricWeb& web, double polar_begin_rad, double polar_end_rad) {
    const auto plane = [&](std::size_t azimuth) {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < web.polar_rad.size(); ++i) {
            const double a = web.polar_rad[i], b = web.polar_rad[i + 1];
            sum += linear_times_sine(a, b, web.at(azimuth, i), web.at(azimuth, i + 1), std::max(a, polar_begin_rad),
                                     std::min(b, polar_end_rad));
        }
        return sum;
    };
    if (web.azimuth_rad.size() == 1) return 2 * std::numbers::pi * plane(0);
    double sum = 0, before = plane(0);
    for (std::size_t i = 1; i < web.azimuth_rad.size(); ++i) {
        const double after = plane(i);
        sum += 0.5 * (before + after) * (web.azimuth_rad[i] - web.azimuth_rad[i - 1]);
        before = after;
    }
    return sum;
}

double Luminaire::factor_at_tilt(double angle_rad) const {
    if (tilt_rad.empty()) return 1;
    const auto above = std::upper_bound(tilt_rad.begin(), tilt_rad.end(), angle_rad);
    if (above == tilt_rad.begin()) return tilt_factor.front();
    if (above == tilt_rad.end()) return tilt_factor.back();
    const auto i = static_cast<std::size_t>(above - tilt_rad.begin());
    return std::lerp(tilt_factor[i - 1], tilt_factor[i], (angle_rad - tilt_rad[i - 1]) / (tilt_rad[i] - tilt_rad[i - 1]));
}

void integrate(Luminaire& luminaire) {
    luminaire.flux_lm = integrated_flux_lm(luminaire.web, 0, std::numbers::pi);
    luminaire.peak_cd = *std::max_element(luminaire.web.candela.begin(), luminaire.web.candela.end());
}

}  // namespace heliodon
