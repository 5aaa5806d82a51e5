#include "core/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>

#include "core/picture_checks.h"
#include "core/separable_filter.h"
#include "core/units.h"

namespace heliodon {
namespace {

/// Where the median of relative errors looks: exposed luminance above this (design of `compare`).
constexpr double dark_limit = 0.001;
/// Keeps relmse finite in the dark.
constexpr double relmse_epsilon = 0.01;

int colour_channels(const Image& image) {
    return image.channels >= 3 ? 3 : 1;
}

Result<void> check_finite(const char* name, const Image& image) {
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            for (int c = 0; c < colour_channels(image); ++c) {
                const float value = image.at(x, y, c);
                if (std::isfinite(value)) continue;
                return fail(name, fmt::format("expected finite values, found {} in channel {} of pixel ({}, {})", value,
                                              c, x, y));
            }
        }
    }
    return {};
}

struct ErrorSums {
    double squared = 0, relative_squared = 0, absolute = 0;
};

/// Sums a row at a time, added in order: the same on any number of threads.
ErrorSums sum_errors(const Image& reference, const Image& test, double exposure) {
    std::vector<ErrorSums> rows(static_cast<std::size_t>(reference.height));
    parallel_rows(reference.height, [&](int y) {
        ErrorSums& sums = rows[static_cast<std::size_t>(y)];
        for (int x = 0; x < reference.width; ++x) {
            const glm::dvec3 r = exposure * glm::dvec3(reference.rgb(x, y));
            const glm::dvec3 d = exposure * glm::dvec3(test.rgb(x, y)) - r;
            for (int c = 0; c < 3; ++c) {
                sums.squared += d[c] * d[c];
                sums.relative_squared += d[c] * d[c] / (r[c] * r[c] + relmse_epsilon);
                sums.absolute += std::abs(d[c]);
            }
        }
    });
    ErrorSums total;
    for (const ErrorSums& row : rows) {
        total.squared += row.squared;
        total.relative_squared += row.relative_squared;
        total.absolute += row.absolute;
    }
    return total;
}

Plane<double> luminance_plane(const Image& image, double exposure) {
    Plane<double> plane(image.width, image.height);
    parallel_rows(image.height, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            plane.row(y)[x] = exposure * units::luminance(glm::dvec3(image.rgb(x, y)));
        }
    });
    return plane;
}

double median_relative_error(const Plane<double>& reference, const Plane<double>& test) {
    std::vector<double> errors;
    errors.reserve(reference.values.size());
    for (std::size_t i = 0; i < reference.values.size(); ++i) {
        const double r = reference.values[i];
        if (r > dark_limit) errors.push_back(std::abs(test.values[i] - r) / r);
    }
    if (errors.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    if (errors.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(errors.begin(), middle));
}

/// Structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004, eq. 13): an 11 × 11 Gaussian window of
/// deviation 1.5, K1 = 0.01, K2 = 0.03, dynamic range 1; the mean over the pixels whose window lies inside
/// the picture, or over all of a picture smaller than the window.
double structural_similarity(const Plane<double>& a, const Plane<double>& b) {
    constexpr int radius = 5;
    constexpr double deviation = 1.5, c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    std::array<double, 2 * radius + 1> window{};
    double sum = 0;
    for (int i = -radius; i <= radius; ++i)
        sum += window[i + radius] = std::exp(-0.5 * i * i / (deviation * deviation));
    for (double& weight : window) weight /= sum;
    const auto local_mean = [&](auto&& value) {
        Plane<double> plane(a.width, a.height);
        for (std::size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = value(a.values[i], b.values[i]);
        return filter_separable<double>(plane, window, window);
    };
    const Plane<double> mean_a = local_mean([](double x, double) { return x; });
    const Plane<double> mean_b = local_mean([](double, double y) { return y; });
    const Plane<double> mean_aa = local_mean([](double x, double) { return x * x; });
    const Plane<double> mean_bb = local_mean([](double, double y) { return y * y; });
    const Plane<double> mean_ab = local_mean([](double x, double y) { return x * y; });

    const bool window_fits = a.width > 2 * radius && a.height > 2 * radius;
    const int border = window_fits ? radius : 0;
    double total = 0;
    for (int y = border; y < a.height - border; ++y) {
        for (int x = border; x < a.width - border; ++x) {
            const double ma = mean_a.row(y)[x], mb = mean_b.row(y)[x];
            const double variance_a = mean_aa.row(y)[x] - ma * ma, variance_b = mean_bb.row(y)[x] - mb * mb;
            const double covariance = mean_ab.row(y)[x] - ma * mb;
            total += (2 * ma * mb + c1) * (2 * covariance + c2) /
                     ((ma * ma + mb * mb + c1) * (variance_a + variance_b + c2));
        }
    }
    return total / (static_cast<double>(a.width - 2 * border) * (a.height - 2 * border));
}

}  // namespace

Result<void> check_comparable(const Image& reference, const Image& test, float ev100) {
    if (reference.width != test.width || reference.height != test.height) {
        return fail("", fmt::format("the pictures differ in size: reference {}x{}, test {}x{}", reference.width,
                                    reference.height, test.width, test.height));
    }
    for (const auto& [name, image] : {std::pair{"reference", &reference}, std::pair{"test", &test}}) {
        const std::size_t values = static_cast<std::size_t>(std::max(image->width, 0)) *
                                   static_cast<std::size_t>(std::max(image->height, 0)) *
                                   static_cast<std::size_t>(std::max(image->channels, 0));
        if (values == 0 || image->pixels.size() != values) return fail(name, "the picture is empty");
        if (auto checked = check_finite(name, *image); !checked) return checked;
    }
    const double exposure = units::exposure_scale(ev100);
    if (!std::isfinite(exposure) || !(exposure > 0.0))
        return fail("", fmt::format("expected a finite exposure, found EV100 {}", ev100));
    return {};
}

Result<Metrics> compare(const Image& reference, const Image& test, float ev100) try {
    const Result<Image> flip = flip_map(reference, test, ev100);
    if (!flip) return tl::unexpected(flip.error());
    const double exposure = units::exposure_scale(ev100);
    const ErrorSums sums = sum_errors(reference, test, exposure);
    const double pixels = static_cast<double>(reference.width) * reference.height;
    Metrics metrics;
    metrics.mse = sums.squared / (3 * pixels);
    metrics.rmse = std::sqrt(metrics.mse);
    metrics.relmse = sums.relative_squared / (3 * pixels);
    metrics.mae = sums.absolute / (3 * pixels);
    metrics.psnr = metrics.mse > 0 ? -10 * std::log10(metrics.mse) : std::numeric_limits<double>::infinity();
    const Plane<double> luminance_r = luminance_plane(reference, exposure),
                        luminance_t = luminance_plane(test, exposure);
    metrics.median_relative = median_relative_error(luminance_r, luminance_t);
    metrics.ssim = structural_similarity(luminance_r, luminance_t);
    double flip_sum = 0;
    for (const float error : flip->pixels) flip_sum += error;
    metrics.flip = flip_sum / pixels;
    return metrics;
} catch (const std::exception& exception) {
    return fail("", fmt::format("cannot compare the pictures: {}", exception.what()));
}

Image heatmap(const Image& map) {
    // The magma colour map (van der Walt and Smith 2015, CC0) by Zucker's least-squares polynomials of
    // degree 6 (2018, CC0), lowest power first; within 0.02 of the table.
    constexpr int degree = 6;
    static const std::array<glm::vec3, degree + 1> magma = {
        glm::vec3(-0.002136485f, -0.000749655f, -0.005386128f), glm::vec3(0.2516605f, 0.6775232f, 2.4940266f),
        glm::vec3(8.3537173f, -3.5777195f, 0.3144679f),         glm::vec3(-27.6687331f, 14.2647308f, -13.6492132f),
        glm::vec3(52.1761398f, -27.9436061f, 12.9441694f),      glm::vec3(-50.7685254f, 29.0465828f, 4.2341530f),
        glm::vec3(18.6557051f, -11.4897735f, -5.6019615f),
    };
    Image colours(map.width, map.height, 3);
    parallel_rows(map.height, [&](int y) {
        for (int x = 0; x < map.width; ++x) {
            const float error = std::clamp(map.at(x, y), 0.0f, 1.0f);
            glm::vec3 colour(0.0f);
            for (int power = degree; power >= 0; --power)
                colour = colour * error + magma[static_cast<std::size_t>(power)];
            colour = glm::clamp(colour, 0.0f, 1.0f);
            for (int c = 0; c < 3; ++c) colours.at(x, y, c) = colour[c];
        }
    });
    return colours;
}

}  // namespace heliodon
