// Lobes of light about a direction: von Mises-Fisher densities (Fisher 1953, "Dispersion on a sphere") of concentration κ. The
// mean of such a lobe over the sphere is its axis × (coth κ − 1/κ): means of several lobes add, weighted by their light.
#ifndef HELIODON_SHADING_SPHERICAL_LOBE_H
#define HELIODON_SHADING_SPHERICAL_LOBE_H
#include "shading/sampling.h"
SHADING_BEGIN

SHADING_CONST float longest_lobe_mean = 0.998f;  // κ = 500, 5° wide: half precision tells no narrower ones apart

/// κ of a lobe, or of several together, whose mean has that length: Banerjee, Dhillon, Ghosh & Sra 2005, eq. 4.4.
SHADING_FN float lobe_concentration(float mean_length) {
    float m = min(mean_length, longest_lobe_mean);
    return m * (3.0f - m * m) / (1.0f - m * m);
}
/// As wide as the lobe and a cone of 1 − cos γ together: an even cone has the mean square of a lobe of κ = 2/(1 − cos γ).
SHADING_FN float lobe_through_cone(float concentration, float one_minus_cos) {
    return concentration / (1.0f + 0.5f * one_minus_cos * concentration);
}
/// Share of a lobe's light per steradian at `cosine` from its axis: κ e^(κ (cos − 1)) / (2π (1 − e^(−2κ))).
SHADING_FN float lobe_density(float concentration, float cosine) {
    float k = max(concentration, 1.0e-3f);
    return k * 0.5f * inverse_pi / (1.0f - exp(-2.0f * k)) * exp(k * (cosine - 1.0f));
}

/// About the mean of max(0, cos) to a plane's normal at `cosine` from the lobe's axis, within 0.02. Of a normal distribution with
/// the mean and variance that the lobe has along the normal (Mardia & Jupp 2000, section 9.3), it would be σ/√(2π) where
/// the mean is 0; that and the asymptotes on both sides make the hyperbola.
SHADING_FN float lobe_clamped_cosine(float concentration, float cosine) {
    float k = max(concentration, 1.0e-1f);
    float opposite = exp(-2.0f * k);
    float mean_cosine = (1.0f + opposite) / (1.0f - opposite) - 1.0f / k;
    float across = mean_cosine / k;
    float along = max(0.0f, 1.0f - 2.0f * across - mean_cosine * mean_cosine);
    float mean = mean_cosine * cosine;
    float variance = mix(across, along, cosine * cosine);
    return 0.5f * (mean + sqrt(mean * mean + 2.0f * inverse_pi * variance));
}

SHADING_END
#endif
