#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/units.h"

namespace heliodon::trace {

struct PathResult {
    glm::dvec3 radiance{0};
    glm::dvec3 direct{0};
};

/// Sequences that a pixel's samples take turns in where their variance is wanted: samples 0, 1, 2, 3 go to the
/// first of the even half, the first of the odd half, the second of the even half, the second of the odd half, and
/// so on. Each sequence has a scrambling of its own, so that what the two of a half say is independent.
inline constexpr int variance_streams = 4;

/// How many of the first `samples` samples of a pixel lie in half 0 (even) or 1 (odd).
[[nodiscard]] inline int samples_in_half(int samples, int half) {
    return (samples + 1 - half) / 2;
}
/// How many of them lie in the first (0) or the second (1) sequence of that half.
[[nodiscard]] inline int samples_in_stream(int samples, int half, int second) {
    return (samples + variance_streams - 1 - half - 2 * second) / variance_streams;
}

/// What the paths through each pixel add up to, each pixel's in the order of its samples: the sums depend on neither
/// tiles nor threads, nor on where the work was interrupted.
struct SampleSums {
    std::size_t halves = 1;  ///< 2 where the variance is wanted
    // By pixel · halves + half.
    std::vector<glm::dvec3> radiance;
    std::vector<glm::dvec3> direct;  ///< empty unless wanted
    std::vector<float> difference;   ///< of the luminance sums of a half's two sequences; empty without variance

    SampleSums() = default;
    SampleSums(std::size_t pixels, bool variance, bool with_direct)
        : halves(variance ? 2 : 1),
          radiance(pixels * halves),
          direct(with_direct ? pixels * halves : 0),
          difference(variance ? pixels * halves : 0) {}

    void add(std::size_t pixel, int sample, const PathResult& result) {
        const std::size_t at = halves == 1 ? pixel : 2 * pixel + static_cast<std::size_t>(sample & 1);
        radiance[at] += result.radiance;
        if (!direct.empty()) direct[at] += result.direct;
        if (halves == 1) return;
        const auto luminance = static_cast<float>(units::luminance(result.radiance));
        difference[at] += sample & 2 ? -luminance : luminance;
    }
};

/// How many samples of its sequence each half of a pixel took: what the sums are sums of.
struct SamplesTaken {
    int half[2] = {0, 0};
    bool by_decision = false;  ///< the counts follow from samples: halves weigh the same, whatever their counts
};

/// The pixel's mean of one kind of sum.
[[nodiscard]] glm::dvec3 pixel_mean(const SampleSums& sums, const std::vector<glm::dvec3>& sum, std::size_t pixel,
                                    const SamplesTaken& taken);

/// Variance of the pixel's mean luminance, (cd/m²)²: from the two independent sequences of each half, two degrees of
/// freedom, unbiased. Infinite where a sequence has no sample yet.
[[nodiscard]] double pixel_variance(const SampleSums& sums, std::size_t pixel, const SamplesTaken& taken);

}  // namespace heliodon::trace
