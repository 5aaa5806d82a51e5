// Sampling until a target error is reached: what it promises, and that what it decides does not bias the picture.
#include "trace/adaptive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene_building.h"

namespace heliodon::tests {
namespace {

using namespace heliodon::trace;

/// Mean and its standard error.
struct Mean {
    double sum = 0, squares = 0;
    int count = 0;
    void add(double value) {
        sum += value;
        squares += value * value;
        ++count;
    }
    [[nodiscard]] double value() const { return sum / count; }
    [[nodiscard]] double error() const {
        return std::sqrt(std::max(0.0, squares / count - value() * value()) / (count - 1));
    }
};

TEST(AdaptiveSampling, IsUnbiasedWhereDecidingByTheSameSamplesIsNot) {
    // Four pixels of a block whose samples are 10 with probability 0.1 and 0 otherwise, like a lamp that is found
    // rarely: whether they look good enough goes with how often they found it.
    constexpr int pixels = 4, repetitions = 20000;
    std::mt19937 random(1);
    std::bernoulli_distribution found(0.1);
    Mean ours, same_samples;
    for (int repetition = 0; repetition < repetitions; ++repetition) {
        const Blocks blocks{pixels, 1};
        AdaptiveSampling adaptive(blocks, 0.3, 0.01);
        SampleSums sums(pixels, true, false);
        double even_sum = 0, even_mean = 0;
        int samples = 0;
        while (!adaptive.finished()) {
            const int next = AdaptiveSampling::next_check(samples);
            const auto want = adaptive.want(0);
            for (int pixel = 0; pixel < pixels; ++pixel)
                for (int i = samples; i < next; ++i) {
                    const double value = found(random) ? 10.0 : 0.0;
                    if (want.picture[i & 1]) sums.add(pixel, i, {glm::dvec3(value), glm::dvec3(0)});
                    if (want.decision[i & 1]) adaptive.add(pixel, i, value);
                    if (want.decision[0] && !(i & 1)) even_sum += value;
                }
            samples = next;
            adaptive.check(samples);
            if (want.decision[0]) even_mean = even_sum / (pixels * samples_in_half(samples, 0));
        }
        double mean = 0;
        for (int pixel = 0; pixel < pixels; ++pixel)
            mean += pixel_mean(sums, sums.radiance, pixel, adaptive.taken(0, samples)).x / pixels;
        ours.add(mean);
        same_samples.add(even_mean);
    }
    RecordProperty("relative_bias_of_deciding_by_the_same_samples", std::to_string(same_samples.value() - 1));
    RecordProperty("relative_bias", std::to_string(ours.value() - 1));
    RecordProperty("standard_error", std::to_string(ours.error()));
    EXPECT_NEAR(ours.value(), 1, 3.5 * ours.error());
    EXPECT_LT(ours.error(), 0.003);
    EXPECT_GT(std::abs(same_samples.value() - 1), 10 * same_samples.error()) << "else this test shows nothing";
}

TEST(AdaptiveSampling, ChecksRarelyAndMostlyAtPowersOfTwo) {
    std::vector<int> checks;
    for (int samples = 0; samples < 300;) checks.push_back(samples = AdaptiveSampling::next_check(samples));
    EXPECT_EQ(checks, (std::vector<int>{32, 48, 64, 96, 128, 192, 256, 384}));
}

/// A lamp out of sight over a ball in a corner: shadows, penumbrae and light from walls, without rare bright paths
/// whose own scatter could not be measured in a test's time.
Scene plain_corner() {
    Scene scene;
    add_shape(scene, Quad{{-2, 0, -1}, {0, 0, 4}, {4, 0, 0}}, lambert(.7f));
    add_shape(scene, Quad{{-2, 0, -1}, {4, 0, 0}, {0, 3, 0}}, lambert(.5f));
    add_shape(scene, Sphere{{.3f, .5f, 0}, .5f}, lambert(.3f));
    add_shape(scene, Quad{{-1, 3, .2f}, {.5f, 0, 0}, {0, 0, .5f}}, lambert(0, 100));
    return scene;
}

PathOptions adaptive_options(double target, std::uint32_t seed = 0) {
    PathOptions options;
    options.width = 48;
    options.height = 16;
    options.samples_per_pixel = 1024;
    options.max_depth = 2;
    options.target_error = target;
    options.seed = seed;
    return options;
}

const Camera& room_camera() {
    static const Camera camera = [] {
        Camera made = looking({0, 1, 3.4f}, {0, .6f, 0});
        made.ev100_override = 2;  // white at 4.8 cd/m²: the floor of errors is 0.048 cd/m²
        return made;
    }();
    return camera;
}

TEST(AdaptiveSampling, ReachesTheErrorThatItStates) {
    const Scene scene = plain_corner();
    PathOptions reference_options = adaptive_options(1);
    reference_options.target_error.reset();
    reference_options.seed = 1000;
    const Picture reference = render(scene, room_camera(), reference_options);
    constexpr double target = 0.04, floor_nits = 0.01 * 1.2 * 4;
    constexpr int seeds = 24;
    const Blocks blocks{48, 16};
    std::vector<double> squares(blocks.count());
    Mean bias;
    double samples = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        PathStatistics statistics;
        const Picture picture = render(scene, room_camera(), adaptive_options(target, seed), &statistics);
        EXPECT_EQ(statistics.target_reached, 1.0);
        EXPECT_LT(statistics.mean_samples_per_pixel, statistics.samples_per_pixel);
        samples += statistics.mean_samples_per_pixel / seeds;
        for (int block = 0; block < blocks.count(); ++block)
            blocks.each_pixel(block, [&](int x, int y) {
                const double truth = luminance(reference.image.rgb(x, y));
                const double error = luminance(picture.image.rgb(x, y)) - truth;
                squares[block] += error * error / (truth * truth + floor_nits * floor_nits) / (64.0 * seeds);
            });
        bias.add(luminance(mean(picture.image)) / luminance(mean(reference.image)) - 1);
    }
    const auto within = std::count_if(squares.begin(), squares.end(), [&](double s) { return s <= target * target; });
    RecordProperty("blocks_within_target", static_cast<int>(within));
    RecordProperty("mean_samples", std::to_string(samples));
    RecordProperty("worst_block", std::to_string(std::sqrt(*std::max_element(squares.begin(), squares.end()))));
    RecordProperty("best_block", std::to_string(std::sqrt(*std::min_element(squares.begin(), squares.end()))));
    EXPECT_EQ(within, blocks.count());
    // The reference has an error of its own: that of 1024 samples, the same as all the pictures together, or so.
    EXPECT_NEAR(bias.value(), 0, 3 * std::hypot(bias.error(), bias.error() * std::sqrt(seeds * samples / 1024)));
}

TEST(Variance, IsThatOfManyPictures) {
    const Scene scene = plain_corner();
    PathOptions options = adaptive_options(1);
    options.target_error.reset();
    options.samples_per_pixel = 64;
    options.aovs = {"variance", "samples"};
    constexpr int seeds = 32;
    std::vector<Mean> pixels(48 * 16);
    Mean said;
    for (int seed = 0; seed < seeds; ++seed) {
        options.seed = seed;
        const Picture picture = render(scene, room_camera(), options);
        ASSERT_EQ(picture.layers.size(), 2u);
        double sum = 0;
        for (int i = 0; i < 48 * 16; ++i) {
            pixels[i].add(luminance(picture.image.rgb(i % 48, i / 48)));
            sum += picture.layers[0].image.pixels[i];
            EXPECT_EQ(picture.layers[1].image.pixels[i], 64);
        }
        said.add(sum / pixels.size());
    }
    double scattered = 0;  // what the pictures themselves scatter by
    for (const Mean& pixel : pixels) scattered += pixel.error() * pixel.error() * seeds / pixels.size();
    RecordProperty("variance_said", std::to_string(said.value()));
    RecordProperty("variance_scattered", std::to_string(scattered));
    EXPECT_NEAR(said.value(), scattered, 0.08 * scattered);
    options.samples_per_pixel = 3;
    EXPECT_TRUE(std::isinf(render(scene, room_camera(), options).layers[0].image.pixels[0])) << "nothing to compare";
}

TEST(Variance, IsThatOfManyAdaptivePictures) {
    const Scene scene = plain_corner();
    PathOptions options = adaptive_options(0.06);
    options.aovs = {"variance", "samples"};
    constexpr int seeds = 32;
    std::vector<Mean> pixels(48 * 16);
    Mean said;
    bool uneven = false;
    for (int seed = 0; seed < seeds; ++seed) {
        options.seed = seed;
        const Picture picture = render(scene, room_camera(), options);
        double sum = 0;
        for (int i = 0; i < 48 * 16; ++i) {
            pixels[i].add(luminance(picture.image.rgb(i % 48, i / 48)));
            sum += picture.layers[0].image.pixels[i];
            uneven = uneven || picture.layers[1].image.pixels[i] != picture.layers[1].image.pixels[0];
        }
        said.add(sum / pixels.size());
    }
    EXPECT_TRUE(uneven) << "every pixel took the same samples";
    double scattered = 0;
    for (const Mean& pixel : pixels) scattered += pixel.error() * pixel.error() * seeds / pixels.size();
    RecordProperty("variance_said", std::to_string(said.value()));
    RecordProperty("variance_scattered", std::to_string(scattered));
    EXPECT_NEAR(said.value(), scattered, 0.08 * scattered);
}

TEST(Determinism, OfEveryModeWhateverTheNumberOfThreads) {
    const Scene scene = small_room();
    const auto options_of = [](bool adaptive, int threads) {
        PathOptions options = adaptive_options(0.3);
        if (!adaptive) options.target_error.reset();
        options.samples_per_pixel = adaptive ? 100 : 10;
        options.aovs = {"direct", "variance", "samples"};
        options.threads = threads;
        return options;
    };
    for (const bool adaptive : {false, true}) {
        const Picture one = render(scene, room_camera(), options_of(adaptive, 1));
        for (const int threads : {2, 8}) {
            const Picture more = render(scene, room_camera(), options_of(adaptive, threads));
            EXPECT_EQ(more.image.pixels, one.image.pixels) << threads;
            for (std::size_t i = 0; i < one.layers.size(); ++i)
                EXPECT_EQ(more.layers[i].image.pixels, one.layers[i].image.pixels) << one.layers[i].name << threads;
        }
    }
}

}  // namespace
}  // namespace heliodon::tests
