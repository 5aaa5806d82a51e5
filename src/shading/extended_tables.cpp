#include "shading/extended_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "shading/fresnel.h"
#include "shading/ggx_anisotropic.h"
#include "shading/quadrature.h"
#include "shading/sheen.h"

namespace heliodon::shading {
namespace {

constexpr std::size_t turn_points = 24, height_points = 16;
constexpr double smallest_mu = 1e-3;  // stands for the limit at grazing incidence

vec3 direction(double mu, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, 1 - mu * mu));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), mu};
}

/// Points of the spherical cap by azimuth and height (Dupuy & Benyoub 2023), the height a cube as tables.cpp has it.
struct CapRule {
    struct Point {
        float depth, cosine, sine, weight;
    };
    std::vector<Point> points;
    CapRule() {
        const GaussLegendre<height_points> heights;
        for (std::size_t k = 0; k < turn_points; ++k)
            for (std::size_t i = 0; i < height_points; ++i) {
                const double phi = 2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / turn_points, height = heights.x[i];
                points.push_back({static_cast<float>(1 - height * height * height), static_cast<float>(std::cos(phi)),
                                  static_cast<float>(std::sin(phi)),
                                  static_cast<float>(3 * height * height * heights.weight[i] / turn_points)});
            }
    }
};

/// (A, B): the mean of G2/G1 (1 − (1 − o·h)⁵) and G2/G1 (1 − o·h)⁵ over the visible normals.
glm::dvec2 albedo_split(vec3 wo, vec2 alpha, const CapRule& rule) {
    const vec3 stretched = normalize(vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z));
    const float seen = 1.0f + ggx_lambda_stretched(wo, alpha);
    glm::dvec2 sum(0);
    for (const CapRule::Point& point : rule.points) {
        const vec3 cap = ggx_cap_normal(stretched, 1.0f, point.depth, point.cosine, point.sine);
        const vec3 h = normalize(vec3(alpha.x * cap.x, alpha.y * cap.y, cap.z));
        const vec3 wi = h * (2.0f * dot(wo, h)) - wo;
        if (wi.z <= 0.0f) continue;
        const double share = point.weight * seen / (seen + ggx_lambda_stretched(wi, alpha)), grazing = schlick_weight(dot(wo, h));
        sum += share * glm::dvec2(1 - grazing, grazing);
    }
    return sum;
}

vec2 stretched_alphas(std::size_t row, std::size_t ratio) {
    const float longer = alpha_of_row(row, stretched_rows);
    const float root = static_cast<float>(ratio) / (stretched_ratios - 1);
    return {longer, std::max(longer * root * root, ggx_smallest_alpha)};
}

/// Where stretched_turn() is entry `t`.
double azimuth_of_turn(double t, vec2 alphas) {
    const double turn = 0.5 * std::numbers::pi * t / (stretched_turns - 1);
    return std::atan2(std::sin(turn) / std::sqrt(alphas.y), std::cos(turn) / std::sqrt(alphas.x));
}

void fill_stretched(std::span<float> table) {
    const CapRule rule;
    for (std::size_t i = 0; i < stretched_columns; ++i) {
        const double x = static_cast<double>(i) / (stretched_columns - 1), mu = std::max(x * x, smallest_mu);
        for (std::size_t j = 0; j < stretched_rows; ++j)
            for (std::size_t r = 0; r < stretched_ratios; ++r)
                for (std::size_t t = 0; t < stretched_turns; ++t) {
                    const vec2 alphas = stretched_alphas(j, r);
                    const glm::dvec2 split = albedo_split(direction(mu, azimuth_of_turn(static_cast<double>(t), alphas)), alphas, rule);
                    const double excess = std::max(1.0, split.x + split.y);  // rounding must not give more than all
                    const std::size_t entry = ((j * stretched_ratios + r) * stretched_turns + t) * stretched_columns + i;
                    table[stretched_albedo_start + 2 * entry] = static_cast<float>(split.x / excess);
                    table[stretched_albedo_start + 2 * entry + 1] = static_cast<float>(split.y / excess);
                }
    }
}

/// 2/π ∫∫ E μ dμ dφ over a quarter turn of what the lookup returns.
void fill_averages(std::span<float> table) {
    const GaussLegendre<24> cosines;
    constexpr std::size_t turns = 24;
    for (std::size_t pair = 0; pair < stretched_rows * stretched_ratios; ++pair) {
        const vec2 alphas = stretched_alphas(pair / stretched_ratios, pair % stretched_ratios);
        glm::dvec2 sum(0);
        for (std::size_t k = 0; k < cosines.x.size(); ++k) {
            const double mu = cosines.x[k], column = std::sqrt(mu) * (stretched_columns - 1);
            const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(column), stretched_columns - 2);
            const double x = column - static_cast<double>(i);
            for (std::size_t t = 0; t < turns; ++t) {
                const double azimuth = 0.5 * std::numbers::pi * (static_cast<double>(t) + 0.5) / turns;
                const double turn = stretched_turn(direction(mu, azimuth), alphas) * (stretched_turns - 1);
                const std::size_t at = std::min<std::size_t>(static_cast<std::size_t>(turn), stretched_turns - 2);
                const auto entry = [&](std::size_t y, std::size_t column_index) {
                    const std::size_t first = stretched_albedo_start + 2 * ((pair * stretched_turns + y) * stretched_columns + column_index);
                    return glm::dvec2(table[first], table[first + 1]);
                };
                const glm::dvec2 found = glm::mix(glm::mix(entry(at, i), entry(at, i + 1), x),
                                                  glm::mix(entry(at + 1, i), entry(at + 1, i + 1), x), turn - static_cast<double>(at));
                sum += cosines.weight[k] * 2 * mu / turns * found;
            }
        }
        table[stretched_average_start + 2 * pair] = static_cast<float>(sum.x);
        table[stretched_average_start + 2 * pair + 1] = static_cast<float>(sum.y);
    }
}

void fill_sheen(std::span<float> table) {
    const GaussLegendre<32> cosines;
    constexpr std::size_t turns = 24;
    for (std::size_t j = 0; j < sheen_rows; ++j) {
        const float alpha = sheen_alpha(static_cast<float>(j) / (sheen_rows - 1));
        for (std::size_t i = 0; i < sheen_columns; ++i) {
            const double x = static_cast<double>(i) / (sheen_columns - 1);
            const vec3 wo = direction(std::max(x * x, smallest_mu), 0);
            double sum = 0;
            for (std::size_t k = 0; k < cosines.x.size(); ++k)
                for (std::size_t t = 0; t < turns; ++t) {
                    // Grazing light counts: the cosines are squares.
                    const double mu = cosines.x[k] * cosines.x[k];
                    const vec3 wi = direction(mu, std::numbers::pi * (static_cast<double>(t) + 0.5) / turns);
                    sum += cosines.weight[k] * 2 * cosines.x[k] * sheen_reflection(wo, wi, normalize(wo + wi), alpha);
                }
            table[sheen_albedo_start + j * sheen_columns + i] = static_cast<float>(2 * std::numbers::pi * sum / turns);
        }
    }
}

}  // namespace

void fill_extended_tables(std::span<float> table) {
    fill_stretched(table);
    fill_averages(table);
    fill_sheen(table);
}

}  // namespace heliodon::shading
