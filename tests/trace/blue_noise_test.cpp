// Pixels of a tile fill each other's gaps: their errors differ from neighbour to neighbour, and are no larger for it.
#include <fmt/format.h>

#include <cmath>
#include <random>
#include <vector>

#include "scene_building.h"
#include "shading/kernel_tile_sampler.h"

namespace heliodon::tests {
namespace {

using namespace heliodon::shading;

vec2 sample_of(uint place, uint sample, uint seed) {
    return kernel_tile_pair(kernel_reverse_bits(sample), kernel_reverse_bits(place), seed);
}

/// Whether the points, 2^m of them, have one in each of the intervals of 2^-a × 2^-(m-a).
bool one_in_each(const std::vector<vec2>& points, int a) {
    const auto count = static_cast<uint>(points.size());
    const uint across = 1u << a, down = count / across;
    std::vector<char> seen(count, 0);
    for (const vec2& point : points) {
        char& cell = seen[static_cast<uint>(point.y * static_cast<float>(down)) * across +
                          static_cast<uint>(point.x * static_cast<float>(across))];
        if (cell) return false;
        cell = 1;
    }
    return true;
}

TEST(TileSampler, EachPixelHasANetAndEachSquareOfPixelsFillsEveryInterval) {
    for (const uint seed : {1u, 77u, 12345u})
        for (int k = 0; k <= 6; ++k)
            for (int q = 0; q <= 8; ++q)
                for (uint square = 0; square < 256u >> q; square += 3) {
                    std::vector<vec2> points;
                    for (uint place = square << q; place < (square + 1) << q; ++place)
                        for (uint i = 0; i < 1u << k; ++i) points.push_back(sample_of(place, i, seed));
                    ASSERT_TRUE(one_in_each(points, k + q)) << "first dimension, k " << k << " q " << q;
                    ASSERT_TRUE(one_in_each(points, 0)) << "second dimension, k " << k << " q " << q;
                    for (int a = 0; q == 0 && a <= k; ++a) ASSERT_TRUE(one_in_each(points, a)) << "a pixel's own net";
                }
}

TEST(TileSampler, NumbersThePixelsOfSquaresOneAfterAnother) {
    EXPECT_EQ(kernel_morton(0, 0), 0u);
    EXPECT_EQ(kernel_morton(1, 0), 1u);
    EXPECT_EQ(kernel_morton(0, 1), 2u);
    EXPECT_EQ(kernel_morton(15, 15), 255u);
    EXPECT_EQ(kernel_morton(5, 9), 0b10010011u);
}

constexpr int side = 64;

/// A room with a lamp, a ball and a box in it.
Picture room(int samples, std::uint32_t seed, bool blue_noise, int max_depth) {
    static const Scene scene = [] {
        Scene made;
        add_shape(made, Quad{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}}, lambert(.7f));
        add_shape(made, Quad{{-1, 0, -1}, {2, 0, 0}, {0, 2, 0}}, lambert(.7f));
        add_shape(made, Quad{{-1, 0, 1}, {0, 0, -2}, {0, 2, 0}}, lambert(.5f));
        add_shape(made, Quad{{1, 0, -1}, {0, 0, 2}, {0, 2, 0}}, lambert(.5f));
        add_shape(made, Quad{{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}}, lambert(.7f));
        add_shape(made, Quad{{-.3f, 1.99f, -.3f}, {.6f, 0, 0}, {0, 0, .6f}}, lambert(0, 20));
        add_shape(made, Sphere{{.4f, .4f, 0}, .4f}, lambert(.6f));
        add_shape(made, Box{{-.7f, 0, -.6f}, {-.2f, 1.1f, -.2f}}, lambert(.6f));
        return made;
    }();
    PathOptions options;
    options.width = options.height = side;
    options.samples_per_pixel = samples;
    options.seed = seed;
    options.blue_noise = blue_noise;
    options.branches = 1;  // a path of four has the numbers of four samples
    options.max_depth = max_depth;
    return render(scene, looking({0, 1, 3.6f}, {0, 1, 0}, 36), options);
}

struct Errors {
    double mean_square = 0;  ///< of pixels
    double low = 0;  ///< of what a Gaussian of two pixels leaves, relative to what it leaves of independent errors
};

/// Of the difference of two independent pictures, which errs as each does, twice over.
Errors errors_of(int samples, bool blue_noise, int max_depth, int pairs) {
    constexpr int reach = 6;
    double kernel[2 * reach + 1], sum = 0, squares = 0;
    for (int i = -reach; i <= reach; ++i) sum += kernel[i + reach] = std::exp(-i * i / 8.0);
    for (double& weight : kernel) squares += std::pow(weight /= sum, 2);
    Errors errors;
    for (int pair = 0; pair < pairs; ++pair) {
        const Image a = room(samples, 2 * pair, blue_noise, max_depth).image,
                    b = room(samples, 2 * pair + 1, blue_noise, max_depth).image;
        std::vector<double> error(side * side);
        for (int i = 0; i < side * side; ++i) {
            const double first = luminance(a.rgb(i % side, i / side)), second = luminance(b.rgb(i % side, i / side));
            // Relative: else the few bright pixels are all that counts.
            error[i] = (first - second) / std::sqrt(first * first + second * second + 1e-4);
            errors.mean_square += error[i] * error[i] / (side * side * pairs);
        }
        for (int y = reach; y < side - reach; ++y)
            for (int x = reach; x < side - reach; ++x) {
                double smooth = 0;
                for (int j = -reach; j <= reach; ++j)
                    for (int i = -reach; i <= reach; ++i)
                        smooth += kernel[j + reach] * kernel[i + reach] * error[(y + j) * side + x + i];
                errors.low += smooth * smooth / (squares * squares * std::pow(side - 2 * reach, 2) * pairs);
            }
    }
    return errors;
}

/// Pictures of so many samples and events; the most that low frequencies may keep.
struct Case {
    int samples, max_depth;
    double low;
};

TEST(BlueNoise, LowFrequenciesOfTheErrorFallAndItsSizeDoesNotRise) {
    for (const auto& [samples, max_depth, low] : {Case{1, 1, .5}, {4, 1, .8}, {1, 0, .75}, {4, 0, .9}}) {
        const int pairs = 16;
        const Errors independent = errors_of(samples, false, max_depth, pairs);
        const Errors blue = errors_of(samples, true, max_depth, pairs);
        const std::string name = fmt::format("samples_{}_depth_{}", samples, max_depth);
        RecordProperty("error_" + name, fmt::format("{:.3f}", blue.mean_square / independent.mean_square));
        RecordProperty("low_frequencies_" + name, fmt::format("{:.3f}", blue.low / independent.low));
        EXPECT_LT(blue.mean_square, 1.05 * independent.mean_square) << name;
        EXPECT_LT(blue.low, low * independent.low) << name;
    }
}

}  // namespace
}  // namespace heliodon::tests
