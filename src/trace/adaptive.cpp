#include "trace/adaptive.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace heliodon::trace {
namespace {

// Fewer samples say too little about what they might have missed.
constexpr int first_check = 32;
constexpr double one_sided_95 = 1.6449;  // standard deviations of a normal distribution

}  // namespace

AdaptiveSampling::AdaptiveSampling(Blocks blocks, double target_error, double floor_nits)
    : blocks_(blocks),
      target_error_(target_error),
      floor_nits_(floor_nits),
      decision_(static_cast<std::size_t>(blocks.width) * blocks.height, glm::vec4(0)),
      state_(static_cast<std::size_t>(blocks.count())) {}

AdaptiveSampling::Want AdaptiveSampling::want(int block) const {
    const Block& state = state_[static_cast<std::size_t>(block)];
    return {{!state.stopped[0], !state.stopped[1]}, {!state.sufficed[0], !state.sufficed[1]}};
}

/// 32, 48, 64, 96, 128, …: rarely enough that decisions cost nothing and that few samples are taken after they
/// would have sufficed; all but every second a power of two, where the sequences are most even.
int AdaptiveSampling::next_check(int samples) {
    int check = first_check;
    while (check <= samples) check += (check & (check - 1)) == 0 ? check / 2 : check / 3;
    return check;
}

/// The mean over the block's pixels of the squared relative standard error, at the upper end of its one-sided 95 %
/// confidence interval, against the target's square.
bool AdaptiveSampling::suffices(int block, int half, int samples) const {
    const double count = samples_in_half(samples, half);
    double luminance = 0;
    int pixels = 0;
    const auto sums_at = [&](int x, int y) { return decision_[static_cast<std::size_t>(y) * blocks_.width + x]; };
    blocks_.each_pixel(block, [&](int x, int y) {
        luminance += sums_at(x, y)[half] / count;
        ++pixels;
    });
    luminance /= pixels;
    double sum = 0, squares = 0;
    blocks_.each_pixel(block, [&](int x, int y) {
        const glm::vec4 sums = sums_at(x, y);
        // A pixel that is bright by one rare sample must not have its error excused by it: at most the block's mean.
        const double least = std::min<double>(sums[half] / count, luminance), apart = sums[2 + half] / count;
        // apart² estimates the variance of this half's mean; that of both halves' is half of it.
        const double relative = 0.5 * apart * apart / (least * least + floor_nits_ * floor_nits_);
        sum += relative;
        squares += relative * relative;
    });
    const double mean = sum / pixels;
    // The squares of single normal values scatter by √2 times their mean, at least: pixels differ besides.
    const double scatter = std::sqrt(std::max(squares / pixels - mean * mean, 2 * mean * mean));
    return mean + one_sided_95 * scatter / std::sqrt(pixels) <= target_error_ * target_error_;
}

bool AdaptiveSampling::neighbourhood_suffices(int block, int half) const {
    const int across = blocks_.across(), column = block % across, row = block / across;
    for (int y = std::max(0, row - 1); y <= std::min(blocks_.down() - 1, row + 1); ++y)
        for (int x = std::max(0, column - 1); x <= std::min(across - 1, column + 1); ++x)
            if (!state_[static_cast<std::size_t>(y) * across + x].sufficed[half]) return false;
    return true;
}

void AdaptiveSampling::check(int samples) {
    tbb::parallel_for(0, blocks_.count(), [&](int block) {
        Block& state = state_[static_cast<std::size_t>(block)];
        for (int half = 0; half < 2; ++half)
            if (!state.sufficed[half] && suffices(block, half, samples)) state.sufficed[half] = samples;
    });
    finished_ = true;
    for (int block = 0; block < blocks_.count(); ++block) {
        Block& state = state_[static_cast<std::size_t>(block)];
        for (int half = 0; half < 2; ++half)
            if (!state.stopped[half] && neighbourhood_suffices(block, 1 - half)) state.stopped[half] = samples;
        finished_ = finished_ && !want(block).any();
    }
}

double AdaptiveSampling::reached() const {
    const auto done = std::count_if(state_.begin(), state_.end(),
                                    [](const Block& state) { return state.stopped[0] && state.stopped[1]; });
    return static_cast<double>(done) / static_cast<double>(state_.size());
}

double AdaptiveSampling::running() const {
    double halves = 0;
    for (int block = 0; block < blocks_.count(); ++block) halves += want(block).half(0) + want(block).half(1);
    return halves / (2.0 * blocks_.count());
}

SamplesTaken AdaptiveSampling::taken(int block, int samples) const {
    const Block& state = state_[static_cast<std::size_t>(block)];
    const auto count = [&](int half) { return state.stopped[half] ? state.stopped[half] : samples; };
    return {{count(0), count(1)}, true};
}

void AdaptiveSampling::restore(std::vector<glm::vec4> decision_sums, std::vector<Block> state) {
    decision_ = std::move(decision_sums);
    state_ = std::move(state);
    finished_ = true;
    for (int block = 0; block < blocks_.count(); ++block) finished_ = finished_ && !want(block).any();
}

}  // namespace heliodon::trace
