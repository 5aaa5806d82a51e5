// LDR-FLIP: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild 2020, "FLIP: A Difference
// Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2). Sections and equation
// numbers below are the paper's.
#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>

#include "core/metrics.h"
#include "core/picture_checks.h"
#include "core/separable_filter.h"
#include "core/units.h"

namespace heliodon {
namespace {

using std::numbers::pi_v;
using FloatPlane = Plane<float>;
using Kernel = std::vector<float>;

/// 0.7 m from a screen 0.7 m wide with 3840 pixels (section 4.1): 67.02.
constexpr float pixels_per_degree = 0.7f * (3840.0f / 0.7f) * (pi_v<float> / 180.0f);

// Section 4.3 and the authors' reference: exponents and the split of the error range.
constexpr float colour_exponent = 0.7f;          // q_c
constexpr float cutoff_fraction = 0.4f;          // p_c
constexpr float cutoff_error = 0.95f;            // p_t
constexpr float feature_exponent = 0.5f;         // q_f
constexpr float feature_width_degrees = 0.082f;  // w, section 4.4

/// Linear Rec. 709 to XYZ, with the rational entries that the authors' reference uses (columns in GLM).
const glm::mat3 rgb_to_xyz(10135552.0f / 24577794.0f, 2613072.0f / 12288897.0f, 1425312.0f / 73733382.0f,
                           8788810.0f / 24577794.0f, 8788810.0f / 12288897.0f, 8788810.0f / 73733382.0f,
                           4435075.0f / 24577794.0f, 887015.0f / 12288897.0f, 70074185.0f / 73733382.0f);
const glm::mat3 xyz_to_rgb = glm::inverse(rgb_to_xyz);
const glm::vec3 white = rgb_to_xyz * glm::vec3(1.0f);

/// YyCxCz (Flohr et al. 1993), section 4.2: an opponent space that is linear in the light.
glm::vec3 ycxcz_from_rgb(glm::vec3 rgb) {
    const glm::vec3 t = rgb_to_xyz * rgb / white;
    return {116.0f * t.y - 16.0f, 500.0f * (t.x - t.y), 200.0f * (t.y - t.z)};
}

glm::vec3 rgb_from_ycxcz(glm::vec3 c) {
    const float y = (c.x + 16.0f) / 116.0f;
    return xyz_to_rgb * (glm::vec3(y + c.y / 500.0f, y, y - c.z / 200.0f) * white);
}

/// CIE L*a*b* (CIE 15:2004, section 8.2.1) with the chroma scaled by lightness for the Hunt effect (eq. 7).
glm::vec3 hunt_lab_from_rgb(glm::vec3 rgb) {
    constexpr float delta = 6.0f / 29.0f;
    const auto f = [](float t) {
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
    };
    const glm::vec3 t = rgb_to_xyz * rgb / white;
    const float lightness = 116.0f * f(t.y) - 16.0f;
    const float chroma_scale = 0.01f * lightness;
    return {lightness, chroma_scale * 500.0f * (f(t.x) - f(t.y)), chroma_scale * 200.0f * (f(t.y) - f(t.z))};
}

/// HyAB distance (Abasi et al. 2020; eq. 8).
float hyab(glm::vec3 a, glm::vec3 b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// One Gaussian of a contrast sensitivity filter: a · sqrt(π/b) · exp(−π² d²/b), d in degrees (eq. 3).
struct SensitivityTerm {
    float a, b;
};
constexpr SensitivityTerm achromatic{1.0f, 0.0047f}, red_green{1.0f, 0.0053f};
constexpr SensitivityTerm blue_yellow_1{34.1f, 0.04f}, blue_yellow_2{13.5f, 0.025f};  // table 1

/// 1-D factor of a term's Gaussian, normalized; the widest term sets the radius of all (section 4.2).
struct SensitivityKernel {
    Kernel weights;
    float volume;  ///< of the whole 2-D term before normalization
};

SensitivityKernel sensitivity_kernel(SensitivityTerm term) {
    constexpr float pi = pi_v<float>;
    const float widest = std::sqrt(blue_yellow_1.b / (2.0f * pi * pi));
    const int radius = static_cast<int>(std::ceil(3.0f * widest * pixels_per_degree));
    Kernel weights;
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) {
        const float degrees = static_cast<float>(x) / pixels_per_degree;
        weights.push_back(std::exp(-pi * pi * degrees * degrees / term.b));
        sum += weights.back();
    }
    for (float& weight : weights) weight = static_cast<float>(weight / sum);
    return {weights, static_cast<float>(term.a * std::sqrt(pi / term.b) * sum * sum)};
}

FloatPlane filter_sensitivity(const FloatPlane& plane, SensitivityTerm term) {
    const Kernel weights = sensitivity_kernel(term).weights;
    return filter_separable<float>(plane, weights, weights);
}

/// The blue-yellow sensitivity is a sum of two Gaussians: not separable, but each of its terms is.
FloatPlane filter_blue_yellow(const FloatPlane& plane) {
    const SensitivityKernel first = sensitivity_kernel(blue_yellow_1), second = sensitivity_kernel(blue_yellow_2);
    FloatPlane result = filter_separable<float>(plane, first.weights, first.weights);
    const FloatPlane other = filter_separable<float>(plane, second.weights, second.weights);
    const float share = first.volume / (first.volume + second.volume);
    parallel_rows(plane.height, [&](int y) {
        float* out = result.row(y);
        const float* in = other.row(y);
        for (int x = 0; x < plane.width; ++x) out[x] = share * out[x] + (1.0f - share) * in[x];
    });
    return result;
}

/// Feature detectors' 1-D factors (section 4.4): a Gaussian and its first and second derivatives, the
/// derivatives' positive and negative parts each normalized to sum to ±1.
/// The derivatives' sums are zero but for rounding, about 1e-7, and the square root of eq. 10 lifts that to
/// 5e-5 of the error on even pictures. Single precision in this order makes it the authors' reference's.
struct FeatureKernels {
    Kernel gaussian, edge, point;
};

void normalize_parts(Kernel& kernel) {
    float positive = 0.0f, negative = 0.0f;
    for (const float weight : kernel) (weight > 0.0f ? positive : negative) += std::abs(weight);
    for (float& weight : kernel) {
        const float sum = weight > 0.0f ? positive : negative;
        if (sum > 0.0f) weight /= sum;
    }
}

FeatureKernels feature_kernels() {
    const float deviation = 0.5f * feature_width_degrees * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0f * deviation));
    FeatureKernels kernels;
    for (int i = -radius; i <= radius; ++i) {
        const auto x = static_cast<float>(i);
        const float gaussian = std::exp(-(x * x) / (2.0f * deviation * deviation));
        kernels.gaussian.push_back(gaussian);
        kernels.edge.push_back(-x * gaussian);
        kernels.point.push_back((x * x / (deviation * deviation) - 1.0f) * gaussian);
    }
    for (Kernel* kernel : {&kernels.gaussian, &kernels.edge, &kernels.point}) normalize_parts(*kernel);
    return kernels;
}

/// Length of the gradient-like vector that `derivative` gives across and down.
FloatPlane feature_strength(const FloatPlane& luma, const Kernel& derivative, const Kernel& gaussian) {
    FloatPlane across = filter_separable<float>(luma, derivative, gaussian);
    const FloatPlane down = filter_separable<float>(luma, gaussian, derivative);
    parallel_rows(luma.height, [&](int y) {
        float* out = across.row(y);
        const float* in = down.row(y);
        for (int x = 0; x < luma.width; ++x) out[x] = std::sqrt(out[x] * out[x] + in[x] * in[x]);
    });
    return across;
}

/// A picture as FLIP's observer sees it.
struct Perceived {
    FloatPlane lightness, chroma_a, chroma_b;  ///< filtered, Hunt-adjusted L*a*b*
    FloatPlane edges, points;
};

Perceived perceive(const Image& image, float exposure) {
    FloatPlane luma(image.width, image.height), cx = luma, cz = luma, unit_luma = luma;
    parallel_rows(image.height, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            // The clipped, sRGB-encoded display value, decoded again: encoding is undone exactly.
            const glm::vec3 c = ycxcz_from_rgb(glm::clamp(exposure * image.rgb(x, y), 0.0f, 1.0f));
            luma.row(y)[x] = c.x;
            cx.row(y)[x] = c.y;
            cz.row(y)[x] = c.z;
            unit_luma.row(y)[x] = (c.x + 16.0f) / 116.0f;
        }
    });
    luma = filter_sensitivity(luma, achromatic);
    cx = filter_sensitivity(cx, red_green);
    cz = filter_blue_yellow(cz);
    parallel_rows(image.height, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            const glm::vec3 rgb = rgb_from_ycxcz({luma.row(y)[x], cx.row(y)[x], cz.row(y)[x]});
            const glm::vec3 lab = hunt_lab_from_rgb(glm::clamp(rgb, 0.0f, 1.0f));
            luma.row(y)[x] = lab.x;
            cx.row(y)[x] = lab.y;
            cz.row(y)[x] = lab.z;
        }
    });
    const FeatureKernels kernels = feature_kernels();
    FloatPlane edges = feature_strength(unit_luma, kernels.edge, kernels.gaussian);
    FloatPlane points = feature_strength(unit_luma, kernels.point, kernels.gaussian);
    return {std::move(luma), std::move(cx), std::move(cz), std::move(edges), std::move(points)};
}

/// Colour error in [0,1]: small distances fill [0, p_t], the rest is squeezed above (eq. 9).
float redistribute(float distance, float largest) {
    const float error = std::pow(distance, colour_exponent);
    const float cutoff = cutoff_fraction * largest;
    if (error < cutoff) return cutoff_error / cutoff * error;
    return cutoff_error + (error - cutoff) / (largest - cutoff) * (1.0f - cutoff_error);
}

}  // namespace

Result<Image> flip_map(const Image& reference, const Image& test, float ev100) try {
    if (auto checked = check_comparable(reference, test, ev100); !checked) return tl::unexpected(checked.error());
    const float exposure = units::exposure_scale(ev100);
    const Perceived r = perceive(reference, exposure), t = perceive(test, exposure);
    // The largest distance there is, green to blue (section 4.3).
    const float largest =
        std::pow(hyab(hunt_lab_from_rgb({0.0f, 1.0f, 0.0f}), hunt_lab_from_rgb({0.0f, 0.0f, 1.0f})), colour_exponent);
    Image map(reference.width, reference.height, 1);
    parallel_rows(map.height, [&](int y) {
        for (int x = 0; x < map.width; ++x) {
            const glm::vec3 lab_r(r.lightness.row(y)[x], r.chroma_a.row(y)[x], r.chroma_b.row(y)[x]);
            const glm::vec3 lab_t(t.lightness.row(y)[x], t.chroma_a.row(y)[x], t.chroma_b.row(y)[x]);
            const float colour = redistribute(hyab(lab_r, lab_t), largest);
            const float edge = std::abs(r.edges.row(y)[x] - t.edges.row(y)[x]);
            const float point = std::abs(r.points.row(y)[x] - t.points.row(y)[x]);
            // Eq. 10; each detector's response reaches √2.
            const float feature =
                std::pow(std::max(edge, point) * std::numbers::sqrt2_v<float> * 0.5f, feature_exponent);
            map.at(x, y) = std::pow(colour, 1.0f - std::min(feature, 1.0f));  // eq. 11
        }
    });
    return map;
} catch (const std::exception& exception) {
    return fail("", std::string("cannot compare the pictures: ") + exception.what());
}

}  // namespace heliodon
