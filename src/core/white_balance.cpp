#include "core/white_balance.h"

namespace heliodon {
namespace {

/// A polynomial in 1000 K / T, the highest power first.
double polynomial(glm::dvec4 coefficients, double x) {
    return ((coefficients.x * x + coefficients.y) * x + coefficients.z) * x + coefficients.w;
}

glm::dvec2 daylight(double temperature_k) {
    const glm::dvec4 coefficients = temperature_k <= 7000 ? glm::dvec4(-4.6070, 2.9678, 0.09911, 0.244063)
                                                          : glm::dvec4(-2.0064, 1.9018, 0.24748, 0.237040);
    const double x = polynomial(coefficients, 1000 / temperature_k);
    return {x, -3.000 * x * x + 2.870 * x - 0.275};
}

/// Within 9e-5 of the exact CIE 1960 (u, v) from 1000 K to 15000 K.
glm::dvec2 black_body(double temperature_k) {
    const double t = temperature_k;
    const double u = (0.860117757 + t * (1.54118254e-4 + t * 1.28641212e-7)) / (1 + t * (8.42420235e-4 + t * 7.08145163e-7));
    const double v = (0.317398726 + t * (4.22806245e-5 + t * 4.20481691e-8)) / (1 + t * (-2.89741816e-5 + t * 1.61456053e-7));
    return glm::dvec2(3 * u, 2 * v) / (2 * u - 8 * v + 4);
}

// Rows as published; GLM's constructor takes columns.
const glm::dmat3 xyz_from_rec709 = glm::transpose(glm::dmat3(0.4124564, 0.3575761, 0.1804375,  //
                                                             0.2126729, 0.7151522, 0.0721750,  //
                                                             0.0193339, 0.1191920, 0.9503041));
const glm::dmat3 bradford = glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614,  //
                                                      -0.7502, 1.7135, 0.0367,  //
                                                      0.0389, -0.0685, 1.0296));

}  // namespace

glm::vec2 white_chromaticity(float temperature_k) {
    return glm::vec2(temperature_k >= 4000 ? daylight(temperature_k) : black_body(temperature_k));
}

glm::mat3 white_balance_matrix(glm::vec2 chromaticity) {
    const glm::dvec3 white(chromaticity.x / chromaticity.y, 1, (1 - chromaticity.x - chromaticity.y) / chromaticity.y);
    const glm::dvec3 neutral = xyz_from_rec709 * glm::dvec3(1);
    const glm::dmat3 to_responses = bradford * xyz_from_rec709;
    const glm::dvec3 gain = (bradford * neutral) / (bradford * white);
    const glm::dmat3 scale(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z);
    return glm::mat3(glm::inverse(to_responses) * scale * to_responses);
}

}  // namespace heliodon
