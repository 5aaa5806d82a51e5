#include "trace/sample_sums.h"

#include <limits>

namespace heliodon::trace {
namespace {

/// The halves' weights in the pixel's mean. Where counts were planned, every sample weighs the same; where one
/// half's samples decided the other's count, each half is unbiased by itself and fixed weights keep the sum so.
void half_weights(const SamplesTaken& taken, double weights[2]) {
    const double even = samples_in_half(taken.half[0], 0), odd = samples_in_half(taken.half[1], 1);
    weights[0] = odd == 0 ? 1.0 : taken.by_decision ? 0.5 : even / (even + odd);
    weights[1] = 1 - weights[0];
}

}  // namespace

glm::dvec3 pixel_mean(const SampleSums& sums, const std::vector<glm::dvec3>& sum, std::size_t pixel,
                      const SamplesTaken& taken) {
    if (sums.halves == 1) return sum[pixel] / static_cast<double>(taken.half[0]);
    if (!taken.by_decision) return (sum[2 * pixel] + sum[2 * pixel + 1]) / static_cast<double>(taken.half[0]);
    double weights[2];
    half_weights(taken, weights);
    glm::dvec3 mean(0);
    for (int half = 0; half < 2; ++half)
        if (weights[half] > 0)
            mean +=
                weights[half] * sum[2 * pixel + half] / static_cast<double>(samples_in_half(taken.half[half], half));
    return mean;
}

double pixel_variance(const SampleSums& sums, std::size_t pixel, const SamplesTaken& taken) {
    double weights[2], variance = 0;
    half_weights(taken, weights);
    for (int half = 0; half < 2; ++half) {
        const double first = samples_in_stream(taken.half[half], half, 0);
        const double second = samples_in_stream(taken.half[half], half, 1);
        if (first == 0 || second == 0) return std::numeric_limits<double>::infinity();
        const double sum = units::luminance(sums.radiance[2 * pixel + half]), less = sums.difference[2 * pixel + half];
        const double apart = (sum + less) / (2 * first) - (sum - less) / (2 * second);
        // E (m1 − m2)² = v/n1 + v/n2, and the half's mean has the variance v/(n1 + n2); for equal counts no more is
        // assumed than that both have the same variance, whatever the law by which it falls with the count.
        variance +=
            weights[half] * weights[half] * apart * apart * first * second / ((first + second) * (first + second));
    }
    return variance;
}

}  // namespace heliodon::trace
