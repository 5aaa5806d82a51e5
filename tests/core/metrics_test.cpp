#include "core/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/units.h"
#include "sample_pictures.h"

namespace heliodon {
namespace {

/// The exposure at which linear values are compared as they are.
const float unit_ev100 = units::ev100_from_saturation_luminance(1.0f);

Metrics metrics_of(const Image& reference, const Image& test, float ev100 = unit_ev100) {
    const Result<Metrics> metrics = compare(reference, test, ev100);
    EXPECT_TRUE(metrics) << metrics.error().text();
    return metrics.value_or(Metrics{});
}

// Reference values: the FLIP authors' implementation at its default viewing conditions and, for constant
// pictures, the metrics' definitions, as collected with the shared data ("Image metrics").
TEST(Metrics, OfConstantGreysMeetTheReferenceValuesToTheirPrintedDigits) {
    const Metrics metrics = metrics_of(Image(64, 48, 3, 0.5f), Image(64, 48, 3, 0.25f));
    EXPECT_NEAR(metrics.flip, 0.451898, 0.5e-6);
    EXPECT_NEAR(metrics.psnr, 12.0412, 0.5e-4);
    EXPECT_NEAR(metrics.ssim, 0.800064, 0.5e-6);
    EXPECT_NEAR(metrics.relmse, 0.240385, 0.5e-6);
    EXPECT_NEAR(metrics.mse, 0.0625, 1e-7);
    EXPECT_NEAR(metrics.rmse, 0.25, 1e-7);
    EXPECT_NEAR(metrics.mae, 0.25, 1e-7);
    EXPECT_NEAR(metrics.median_relative, 0.5, 1e-7);
}

TEST(Metrics, FlipOfBlackAgainstWhiteMeetsTheReferenceValue) {
    EXPECT_NEAR(metrics_of(Image(40, 40, 3, 0.0f), Image(40, 40, 3, 1.0f)).flip, 0.967388, 0.5e-6);
}

TEST(Metrics, OfEqualPicturesAreZeroAndPerfect) {
    const Image picture = tests::hdr_noise(50, 30, 3, 1);
    const Metrics metrics = metrics_of(picture, picture);
    EXPECT_EQ(metrics.mse, 0);
    EXPECT_EQ(metrics.relmse, 0);
    EXPECT_EQ(metrics.mae, 0);
    EXPECT_EQ(metrics.median_relative, 0);
    EXPECT_EQ(metrics.flip, 0);
    EXPECT_DOUBLE_EQ(metrics.ssim, 1);
    EXPECT_EQ(metrics.psnr, std::numeric_limits<double>::infinity());
}

TEST(Metrics, SeeOnlyExposedValues) {
    Image reference = tests::unit_noise(40, 30, 3, 2), test = tests::unit_noise(40, 30, 3, 3);
    const Metrics before = metrics_of(reference, test);
    const float ev100 = 12.0f, factor = 1.2f * 4096.0f;
    for (Image* picture : {&reference, &test}) {
        for (float& value : picture->pixels) value *= factor;
    }
    const Metrics after = metrics_of(reference, test, ev100);
    EXPECT_NEAR(after.mse, before.mse, 1e-6);
    EXPECT_NEAR(after.relmse, before.relmse, 1e-5);
    EXPECT_NEAR(after.ssim, before.ssim, 1e-6);
    EXPECT_NEAR(after.flip, before.flip, 1e-5);
    EXPECT_NEAR(after.median_relative, before.median_relative, 1e-6);
}

TEST(Metrics, FollowTheirDefinitionsOnNoise) {
    const Image reference = tests::unit_noise(19, 14, 3, 4), test = tests::unit_noise(19, 14, 3, 5);
    double squared = 0, relative = 0, absolute = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        const double r = reference.pixels[i], d = test.pixels[i] - r;
        squared += d * d;
        relative += d * d / (r * r + 0.01);
        absolute += std::abs(d);
    }
    const double count = static_cast<double>(reference.pixels.size());
    const Metrics metrics = metrics_of(reference, test);
    EXPECT_NEAR(metrics.mse, squared / count, 1e-6);
    EXPECT_NEAR(metrics.relmse, relative / count, 1e-5);
    EXPECT_NEAR(metrics.mae, absolute / count, 1e-6);
    EXPECT_NEAR(metrics.rmse * metrics.rmse, metrics.mse, 1e-12);
    EXPECT_NEAR(metrics.psnr, -10 * std::log10(squared / count), 1e-5);
}

TEST(Metrics, MedianRelativeErrorLooksAtLuminanceWhereTheReferenceIsNotDark) {
    Image reference(4, 1, 3, 0.5f), test(4, 1, 3, 0.5f);
    const float errors[] = {0.1f, 0.2f, 0.4f};
    for (int x = 0; x < 3; ++x) {
        for (int c = 0; c < 3; ++c) test.at(x, 0, c) = 0.5f * (1.0f + errors[x]);
    }
    for (int c = 0; c < 3; ++c) reference.at(3, 0, c) = 0.0005f;  // too dark to count
    EXPECT_NEAR(metrics_of(reference, test).median_relative, 0.2, 1e-6);
    for (int c = 0; c < 3; ++c) reference.at(3, 0, c) = 0.5f;  // now four errors: 0, 0.1, 0.2, 0.4
    EXPECT_NEAR(metrics_of(reference, test).median_relative, 0.15, 1e-6);
    EXPECT_TRUE(std::isnan(metrics_of(Image(4, 4, 3), Image(4, 4, 3, 1.0f)).median_relative));
}

double weighted_mean(const Image& a, const Image& b, int x0, int y0,
                     const std::function<double(double, double)>& value) {
    double sum = 0, weights = 0;
    for (int j = -5; j <= 5; ++j) {
        for (int i = -5; i <= 5; ++i) {
            const double weight = std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5));
            const auto y_of = [&](const Image& image) {
                const glm::vec3 c = image.rgb(x0 + i, y0 + j);
                return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
            };
            sum += weight * value(y_of(a), y_of(b));
            weights += weight;
        }
    }
    return sum / weights;
}

TEST(Metrics, StructuralSimilarityIsTheMeanOverWholeWindows) {
    const Image a = tests::unit_noise(16, 15, 3, 6), b = tests::unit_noise(16, 15, 3, 7);
    double total = 0;
    for (int y = 5; y < 10; ++y) {
        for (int x = 5; x < 11; ++x) {
            const double ma = weighted_mean(a, b, x, y, [](double p, double) { return p; });
            const double mb = weighted_mean(a, b, x, y, [](double, double q) { return q; });
            const double va = weighted_mean(a, b, x, y, [&](double p, double) { return (p - ma) * (p - ma); });
            const double vb = weighted_mean(a, b, x, y, [&](double, double q) { return (q - mb) * (q - mb); });
            const double cov = weighted_mean(a, b, x, y, [&](double p, double q) { return (p - ma) * (q - mb); });
            total += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
        }
    }
    EXPECT_NEAR(metrics_of(a, b).ssim, total / 30, 1e-6);
}

// ---- FLIP written out from the paper once more, with plain two-dimensional sums in double precision.

using Values = std::vector<double>;
using Weight = std::function<double(double x, double y)>;

struct PlainFlip {
    int width, height;
    double ppd = 0.7 * 3840 / 0.7 * std::numbers::pi / 180;
    glm::dmat3 to_xyz = glm::transpose(glm::dmat3(10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,
                                                  2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897,
                                                  1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382));
    glm::dvec3 white = to_xyz * glm::dvec3(1);

    [[nodiscard]] Values convolve(const Values& in, int radius, const Weight& weight, bool split) const {
        double positive = 0, negative = 0;
        for (int j = -radius; j <= radius; ++j) {
            for (int i = -radius; i <= radius; ++i) (weight(i, j) > 0 ? positive : negative) += std::abs(weight(i, j));
        }
        if (!split) positive = negative = positive - negative;
        Values out(in.size());
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                double& sum = out[static_cast<std::size_t>(y * width + x)];
                for (int j = -radius; j <= radius; ++j) {
                    for (int i = -radius; i <= radius; ++i) {
                        const double w = weight(i, j);
                        const int sx = std::clamp(x + i, 0, width - 1), sy = std::clamp(y + j, 0, height - 1);
                        sum += w / (w > 0 ? positive : negative) * in[static_cast<std::size_t>(sy * width + sx)];
                    }
                }
            }
        }
        return out;
    }
    [[nodiscard]] Weight sensitivity(double a1, double b1, double a2, double b2) const {
        return [=, this](double x, double y) {
            const double pi = std::numbers::pi, d2 = (x * x + y * y) / (ppd * ppd);
            return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * d2 / b1) +
                   a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * d2 / b2);
        };
    }
    [[nodiscard]] glm::dvec3 hunt_lab(glm::dvec3 rgb) const {
        const glm::dvec3 t = to_xyz * glm::clamp(rgb, 0.0, 1.0) / white;
        const auto f = [](double v) { return v > 216.0 / 24389 ? std::cbrt(v) : (24389.0 / 27 * v + 16) / 116; };
        const double lightness = 116 * f(t.y) - 16;
        return {lightness, 0.01 * lightness * 500 * (f(t.x) - f(t.y)), 0.01 * lightness * 200 * (f(t.y) - f(t.z))};
    }
    static double distance(glm::dvec3 a, glm::dvec3 b) {
        return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), 0.7);
    }
    struct Seen {
        std::vector<glm::dvec3> lab;
        Values edges, points;
    };
    [[nodiscard]] Seen see(const Image& image) const {
        const auto count = static_cast<std::size_t>(width * height);
        Values y(count), cx(count), cz(count), luma(count);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 rgb =
                glm::clamp(glm::dvec3(image.pixels[3 * i], image.pixels[3 * i + 1], image.pixels[3 * i + 2]), 0.0, 1.0);
            const glm::dvec3 t = to_xyz * rgb / white;
            y[i] = 116 * t.y - 16, cx[i] = 500 * (t.x - t.y), cz[i] = 200 * (t.y - t.z), luma[i] = t.y;
        }
        const int radius =
            static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * std::numbers::pi * std::numbers::pi)) * ppd));
        y = convolve(y, radius, sensitivity(1, 0.0047, 0, 1e-5), false);
        cx = convolve(cx, radius, sensitivity(1, 0.0053, 0, 1e-5), false);
        cz = convolve(cz, radius, sensitivity(34.1, 0.04, 13.5, 0.025), false);
        Seen seen;
        for (std::size_t i = 0; i < count; ++i) {
            const double v = (y[i] + 16) / 116;
            seen.lab.push_back(
                hunt_lab(glm::inverse(to_xyz) * (glm::dvec3(v + cx[i] / 500, v, v - cz[i] / 200) * white)));
        }
        const double sd = 0.5 * 0.082 * ppd;
        const int feature_radius = static_cast<int>(std::ceil(3 * sd));
        const auto gauss = [sd](double a, double b) { return std::exp(-(a * a + b * b) / (2 * sd * sd)); };
        const auto strength = [&](const std::function<double(double)>& factor) {
            const Values across = convolve(
                luma, feature_radius, [&](double a, double b) { return factor(a) * gauss(a, b); }, true);
            const Values down = convolve(
                luma, feature_radius, [&](double a, double b) { return factor(b) * gauss(a, b); }, true);
            Values length(count);
            for (std::size_t i = 0; i < count; ++i) length[i] = std::hypot(across[i], down[i]);
            return length;
        };
        seen.edges = strength([](double a) { return -a; });
        seen.points = strength([sd](double a) { return a * a / (sd * sd) - 1; });
        return seen;
    }
    [[nodiscard]] Values map(const Image& reference, const Image& test) const {
        const Seen r = see(reference), t = see(test);
        const double largest = distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1}));
        Values errors;
        for (std::size_t i = 0; i < r.lab.size(); ++i) {
            const double d = distance(r.lab[i], t.lab[i]), cutoff = 0.4 * largest;
            const double colour = d < cutoff ? 0.95 * d / cutoff : 0.95 + 0.05 * (d - cutoff) / (largest - cutoff);
            const double feature = std::max(std::abs(r.edges[i] - t.edges[i]), std::abs(r.points[i] - t.points[i]));
            errors.push_back(std::pow(colour, 1 - std::sqrt(feature / std::numbers::sqrt2)));
        }
        return errors;
    }
};

TEST(Flip, AgreesWithThePaperWrittenOutPlainly) {
    const Image reference = tests::gradient(34, 27);
    Image test = tests::unit_noise(34, 27, 3, 8);
    for (int y = 4; y < 20; ++y) test.at(9, y, 0) = 3.0f;  // clipped, and a thin line for the feature detectors
    const Result<Image> map = flip_map(reference, test, unit_ev100);
    ASSERT_TRUE(map);
    const Values expected = PlainFlip{34, 27}.map(reference, test);
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(map->pixels[i], expected[i], 2e-5) << i;
}

TEST(Flip, IsSymmetricAndStaysWithinZeroAndOne) {
    const Image a = tests::hdr_noise(45, 33, 3, 9), b = tests::unit_noise(45, 33, 3, 10);
    const Result<Image> ab = flip_map(a, b, unit_ev100), ba = flip_map(b, a, unit_ev100);
    ASSERT_TRUE(ab && ba);
    for (std::size_t i = 0; i < ab->pixels.size(); ++i) {
        EXPECT_FLOAT_EQ(ab->pixels[i], ba->pixels[i]);
        EXPECT_GE(ab->pixels[i], 0.0f);
        EXPECT_LE(ab->pixels[i], 1.0f);
    }
}

TEST(Metrics, OfPicturesSmallerThanTheWindowsAreDefined) {
    for (const int size : {1, 2, 10}) {
        const Metrics metrics = metrics_of(Image(size, size, 3, 0.5f), Image(size, size, 3, 0.25f));
        EXPECT_NEAR(metrics.ssim, 0.800064, 0.5e-6);
        EXPECT_NEAR(metrics.flip, 0.451898, 0.5e-6);
    }
}

TEST(Metrics, LeaveAlphaOutAndTakeGreyAsRgb) {
    const Image reference = tests::unit_noise(20, 20, 3, 11), test = tests::unit_noise(20, 20, 3, 12);
    Image with_alpha(20, 20, 4, std::numeric_limits<float>::quiet_NaN());
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 20; ++x) {
            for (int c = 0; c < 3; ++c) with_alpha.at(x, y, c) = reference.at(x, y, c);
        }
    }
    EXPECT_EQ(metrics_of(with_alpha, test).mse, metrics_of(reference, test).mse);
    EXPECT_NEAR(metrics_of(Image(20, 20, 1, 0.5f), Image(20, 20, 3, 0.25f)).mse, 0.0625, 1e-7);
}

TEST(Metrics, OfDifferentSizesAreRefusedWithBothSizes) {
    const Result<Metrics> metrics = compare(Image(64, 48, 3), Image(64, 47, 3), 0);
    ASSERT_FALSE(metrics);
    EXPECT_NE(metrics.error().message.find("64x48"), std::string::npos);
    EXPECT_NE(metrics.error().message.find("64x47"), std::string::npos);
    EXPECT_FALSE(flip_map(Image(2, 2, 3), Image(2, 3, 3), 0));
}

TEST(Metrics, OfWhatIsNotFiniteAreRefusedWithItsPlace) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image test(8, 8, 3, 1.0f);
        test.at(5, 6, 1) = value;
        const Result<Metrics> metrics = compare(Image(8, 8, 3, 1.0f), test, 0);
        ASSERT_FALSE(metrics);
        EXPECT_EQ(metrics.error().where, "test");
        EXPECT_NE(metrics.error().message.find("(5, 6)"), std::string::npos) << metrics.error().message;
    }
    EXPECT_FALSE(compare(Image(8, 8, 3), Image(8, 8, 3), std::numeric_limits<float>::quiet_NaN()));
    EXPECT_FALSE(compare(Image(), Image(), 0));
}

// The ends and the middle of matplotlib's magma table.
TEST(Heatmap, RunsThroughTheMagmaColours) {
    Image map(3, 1, 1);
    map.pixels = {0.0f, 0.5f, 1.0f};
    const Image colours = heatmap(map);
    const glm::vec3 expected[] = {
        {0.001462f, 0.000466f, 0.013866f}, {0.716387f, 0.214982f, 0.475290f}, {0.987053f, 0.991438f, 0.749504f}};
    for (int x = 0; x < 3; ++x) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(colours.rgb(x, 0)[c], expected[x][c], 0.02f);
    }
}

}  // namespace
}  // namespace heliodon
