#include "shading/plane_lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shading/quadrature.h"
#include "shading/spherical_lobe.h"

namespace heliodon::shading {
namespace {

constexpr std::size_t heights = 48;
constexpr double longest_solved = 0.98;  // the quadrature's heights are too few for narrower lobes

/// e^−t I₀(t) and e^−t I₁(t) for t ≥ 0: Abramowitz & Stegun 1964, eqs. 9.8.1 to 9.8.4, within 3·10⁻⁷.
glm::dvec2 scaled_bessel(double t) {
    if (t < 3.75) {
        const double y = t * t / (3.75 * 3.75), scale = std::exp(-t);
        return {scale * (1 + y * (3.5156229 + y * (3.0899424 + y * (1.2067492 + y * (0.2659732 + y * (0.0360768 + y * 0.0045813)))))),
                scale * t * (0.5 + y * (0.87890594 + y * (0.51498869 + y * (0.15084934 + y * (0.02658733 + y * (0.00301532 + y * 0.00032411))))))};
    }
    const double y = 3.75 / t, scale = 1 / std::sqrt(t);
    return {scale * (0.39894228 + y * (0.01328592 + y * (0.00225319 + y * (-0.00157565 + y * (0.00916281 +
                     y * (-0.02057706 + y * (0.02635537 + y * (-0.01647633 + y * 0.00392377)))))))),
            scale * (0.39894228 + y * (-0.03988024 + y * (-0.00362018 + y * (0.00163801 + y * (-0.01031555 +
                     y * (0.02282967 + y * (-0.02895312 + y * (0.01787654 + y * -0.00420059))))))))};
}

/// Of which lobe_concentration() is `concentration`: m of m (3 − m²) = κ (1 − m²), which grows with m, by bisection.
double mean_length(double concentration) {
    double low = 0, high = 1;
    for (int step = 0; step < 40; ++step) {
        const double m = 0.5 * (low + high);
        (m * (3 - m * m) < concentration * (1 - m * m) ? low : high) = m;
    }
    return low;
}

/// Of the flux of radiance e^(η·ω) through the plane.
struct FluxMoments {
    double flux = 0;  // × e^−|η|
    glm::dvec2 mean{0};
    glm::dvec3 covariance{0};  // xx, yy, xy
};
FluxMoments flux_moments(glm::dvec2 eta) {
    static const GaussLegendre<heights> rule;
    const double concentration = glm::length(eta);
    FluxMoments sum;
    glm::dvec3 squares(0);
    for (std::size_t i = 0; i < heights; ++i) {
        const double z = rule.x[i], sine = std::sqrt(1 - z * z), t = std::abs(eta.x) * sine;
        const glm::dvec2 bessel = scaled_bessel(t);
        const double scale = rule.weight[i] * 2 * std::numbers::pi * z * std::exp(eta.y * z + t - concentration);
        const double even = scale * bessel.x, odd = scale * bessel.y * std::copysign(sine, eta.x);
        const double second = t > 1e-6 ? even - scale * bessel.y / t : 0.5 * even;  // ∫ cos²φ: (I₀ + I₂)/2, I₂ = I₀ − 2 I₁/t
        sum.flux += even;
        sum.mean += glm::dvec2(odd, even * z);
        squares += glm::dvec3(second * sine * sine, even * z * z, odd * z);
    }
    sum.mean /= sum.flux;
    sum.covariance = squares / sum.flux - glm::dvec3(sum.mean.x * sum.mean.x, sum.mean.y * sum.mean.y, sum.mean.x * sum.mean.y);
    return sum;
}

/// What of radiance makes flux of the mean `m`, for narrow lobes: a density of concentration κ about m over the cosine, which is
/// e^(κ m·ω − ω·n/(m·n)) to first order about m.
glm::dvec2 narrow_lobe(glm::dvec2 m) {
    const double length = glm::length(m);
    return double(lobe_concentration(static_cast<float>(length))) * m / length - glm::dvec2(0, length / m.y);
}

}  // namespace

PlaneLobe plane_lobe(glm::dvec2 flux_mean) {
    glm::dvec2 eta = narrow_lobe(flux_mean);
    const bool solved = glm::length(flux_mean) < longest_solved;
    FluxMoments moments;
    for (int step = 0; solved && step < 40; ++step) {
        moments = flux_moments(eta);
        const glm::dvec2 left = flux_mean - moments.mean;
        if (std::max(std::abs(left.x), std::abs(left.y)) < 1e-5) break;
        const glm::dvec3 c = moments.covariance;
        // Newton's step: the mean's derivative by η is the covariance.
        glm::dvec2 change = glm::dvec2(c.y * left.x - c.z * left.y, c.x * left.y - c.z * left.x) / (c.x * c.y - c.z * c.z);
        const double longest = std::max(2.0, 0.5 * glm::length(eta));
        change *= std::min(1.0, longest / glm::length(change));
        eta += change;
    }
    PlaneLobe lobe;
    // No narrower than shaders have them: the density and the clamped cosine must be of one lobe.
    const double concentration = std::clamp(glm::length(eta), 1e-6, double(lobe_concentration(longest_lobe_mean)));
    eta /= std::max(glm::length(eta), 1e-6);
    lobe.mean = eta * mean_length(concentration);
    if (solved) {
        // The density over the sphere is κ e^(κ (a·ω − 1)) / (2π (1 − e^−2κ)).
        lobe.clamped_cosine = moments.flux * concentration / (2 * std::numbers::pi * -std::expm1(-2 * concentration));
    } else {
        const double deviation = std::sqrt(std::max(1 - lobe.mean.y * lobe.mean.y, 0.0) / concentration), t = lobe.mean.y / deviation;
        lobe.clamped_cosine = deviation * std::exp(-0.5 * t * t) / std::sqrt(2 * std::numbers::pi) +
                              lobe.mean.y * 0.5 * std::erfc(-t / std::numbers::sqrt2);
    }
    return lobe;
}

}  // namespace heliodon::shading
