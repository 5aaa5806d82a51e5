#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "trace/sample_sums.h"

namespace heliodon::trace {

/// The picture in squares of 8 × 8 pixels: the unit of work and of decisions about it.
struct Blocks {
    static constexpr int side = 8;
    int width = 0, height = 0;  ///< of the picture
    [[nodiscard]] int across() const { return (width + side - 1) / side; }
    [[nodiscard]] int down() const { return (height + side - 1) / side; }
    [[nodiscard]] int count() const { return across() * down(); }
    [[nodiscard]] int of(int x, int y) const { return y / side * across() + x / side; }
    template <class Visit>
    void each_pixel(int block, Visit&& visit) const {
        const int x0 = block % across() * side, y0 = block / across() * side;
        for (int y = y0; y < std::min(y0 + side, height); ++y)
            for (int x = x0; x < std::min(x0 + side, width); ++x) visit(x, y);
    }
};

/// When blocks have had samples enough (docs/path-tracing.md derives it). The even samples say when the odd ones
/// suffice and the odd ones when the even ones do, so that each half's count is independent of its own values and
/// its mean stays exactly unbiased.
class AdaptiveSampling {
public:
    /// `floor_nits`: errors are relative to √(L² + floor²), L the lesser of the pixel's and its block's luminance.
    AdaptiveSampling(Blocks blocks, double target_error, double floor_nits);

    /// What a block still wants of the samples of a half.
    struct Want {
        bool picture[2], decision[2];
        [[nodiscard]] bool half(int h) const { return picture[h] || decision[h]; }
        [[nodiscard]] bool any() const { return half(0) || half(1); }
    };
    [[nodiscard]] Want want(int block) const;
    void add(std::size_t pixel, int sample, double luminance) {
        glm::vec4& sums = decision_[pixel];
        const auto value = static_cast<float>(luminance);
        const int half = sample & 1;
        sums[half] += value;
        sums[2 + half] += sample & 2 ? -value : value;
    }
    /// The samples a pixel at which `check` is next due.
    [[nodiscard]] static int next_check(int samples);
    /// Lets go of what `samples` samples a pixel suffice for.
    void check(int samples);

    [[nodiscard]] bool finished() const { return finished_; }
    /// The part of all blocks that has reached the target.
    [[nodiscard]] double reached() const;
    /// The part of all pixels' work that goes on.
    [[nodiscard]] double running() const;
    [[nodiscard]] SamplesTaken taken(int block, int samples) const;

    // What interrupted work is taken up from.
    struct Block {
        int sufficed[2] = {0,
                           0};    ///< samples after which this half's own error was first within the target; 0: not yet
        int stopped[2] = {0, 0};  ///< samples after which the half was let go of; 0: not yet
    };
    [[nodiscard]] const std::vector<glm::vec4>& decision_sums() const { return decision_; }
    [[nodiscard]] const Block& block(int i) const { return state_[static_cast<std::size_t>(i)]; }
    void restore(std::vector<glm::vec4> decision_sums, std::vector<Block> state);

private:
    [[nodiscard]] bool suffices(int block, int half, int samples) const;
    [[nodiscard]] bool neighbourhood_suffices(int block, int half) const;

    Blocks blocks_;
    double target_error_, floor_nits_;
    std::vector<glm::vec4>
        decision_;  ///< by pixel: luminance of the even and odd samples; of their sequences' difference
    std::vector<Block> state_;
    bool finished_ = false;
};

}  // namespace heliodon::trace
