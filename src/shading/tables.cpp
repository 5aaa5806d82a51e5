#include "shading/tables.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "shading/fresnel.h"
#include "shading/ggx_albedo.h"

namespace heliodon::shading {
namespace {

template <std::size_t N>
struct GaussLegendre {  // on [0, 1]
    std::array<double, N> x{}, weight{};
    GaussLegendre() {
        // Newton's iteration on the Legendre polynomial from Tricomi's estimate of its roots.
        for (std::size_t i = 0; i < N; ++i) {
            double z = std::cos(std::numbers::pi * (i + 0.75) / (N + 0.5)), derivative = 1;
            for (int iteration = 0; iteration < 20; ++iteration) {
                double p = 1, previous = 0;
                for (std::size_t k = 0; k < N; ++k) {
                    const double next = ((2.0 * k + 1.0) * z * p - k * previous) / (k + 1.0);
                    previous = p;
                    p = next;
                }
                derivative = N * (z * p - previous) / (z * z - 1.0);
                z -= p / derivative;
            }
            x[i] = 0.5 * (1.0 - z);
            weight[i] = 1.0 / ((1.0 - z * z) * derivative * derivative);
        }
    }
};

constexpr std::size_t cap_points = 32, angle_points = 24;

/// (A, B): the mean of G2/G1 (1 − (1 − o·h)⁵) and G2/G1 (1 − o·h)⁵ over the visible normals. The half
/// turn φ in [0, π] suffices by symmetry; the midpoint rule is spectrally accurate in a periodic angle.
glm::dvec2 directional_albedo(float mu, float alpha, const GaussLegendre<cap_points>& rule) {
    const vec3 wo(std::sqrt(std::max(0.0f, 1.0f - mu * mu)), 0.0f, mu);
    const float g1 = ggx_g1(mu, alpha);
    glm::dvec2 sum(0);
    for (std::size_t i = 0; i < cap_points; ++i) {
        for (std::size_t k = 0; k < angle_points; ++k) {
            const vec2 u(0.5f * (k + 0.5f) / angle_points, static_cast<float>(rule.x[i]));
            const vec3 h = ggx_sample_visible_normal(wo, alpha, u);
            const vec3 wi = 2.0f * dot(wo, h) * h - wo;
            if (wi.z <= 0.0f) continue;
            const double value = rule.weight[i] / angle_points * ggx_g2(mu, wi.z, alpha) / g1;
            const double fresnel = schlick_weight(dot(wo, h));
            sum += glm::dvec2(1.0 - fresnel, fresnel) * value;
        }
    }
    return sum;
}

/// 2 ∫ f μ dμ of one interpolated row, exactly: with x = √μ, 4 ∫ f(x) x³ dx and f linear in each cell.
glm::dvec2 row_average(std::span<const float> row) {
    static const GaussLegendre<3> rule;
    const double step = 1.0 / (ggx_albedo_columns - 1);
    glm::dvec2 sum(0);
    for (std::size_t i = 0; i + 1 < ggx_albedo_columns; ++i) {
        const glm::dvec2 left(row[2 * i], row[2 * i + 1]), right(row[2 * i + 2], row[2 * i + 3]);
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = (i + rule.x[k]) * step;
            sum += rule.weight[k] * step * 4.0 * x * x * x * glm::mix(left, right, rule.x[k]);
        }
    }
    return sum;
}

std::vector<float> compute_tables() {
    const GaussLegendre<cap_points> rule;
    std::vector<float> table(shading_table_size);
    const double smallest = std::sqrt(static_cast<double>(ggx_smallest_alpha));
    for (std::size_t j = 0; j < ggx_albedo_rows; ++j) {
        const double root = smallest + (1.0 - smallest) * j / (ggx_albedo_rows - 1);
        float* row = &table[2 * j * ggx_albedo_columns];
        for (std::size_t i = 0; i < ggx_albedo_columns; ++i) {
            const double x = static_cast<double>(i) / (ggx_albedo_columns - 1);
            // At μ = 0 every visible facet reflects upward unshadowed, at o·h → the cap's mean; a
            // tiny cosine stands for the limit.
            const float mu = static_cast<float>(std::max(x * x, 1e-6));
            const glm::dvec2 ab = directional_albedo(mu, static_cast<float>(root * root), rule);
            row[2 * i] = static_cast<float>(ab.x);
            row[2 * i + 1] = static_cast<float>(ab.y);
        }
        const glm::dvec2 average = row_average({row, 2 * ggx_albedo_columns});
        table[ggx_albedo_averages + 2 * j] = static_cast<float>(average.x);
        table[ggx_albedo_averages + 2 * j + 1] = static_cast<float>(average.y);
    }
    return table;
}

}  // namespace

std::span<const float> shading_tables() {
    static const std::vector<float> table = compute_tables();
    return table;
}

}  // namespace heliodon::shading
