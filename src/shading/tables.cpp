#include "shading/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "shading/extended_tables.h"
#include "shading/fresnel.h"
#include "shading/ggx_albedo.h"
#include "shading/plane_lobe.h"
#include "shading/quadrature.h"

namespace heliodon::shading {
namespace {

// As many points as a fifth of a second allows; ggx_albedo.h says what error they leave.
constexpr std::size_t angle_points = 24;
using Cap = GaussLegendre<12>;

/// The visible normals of one view in the plane y = 0: `height` in [0, 1] is the cube root of the height on
/// the stretched cap, which spreads the long tail of steep normals that a smooth surface's losses come from.
struct VisibleNormals {
    vec3 wo, stretched;
    float alpha, g1;

    VisibleNormals(float mu, float alpha_)
        : wo(std::sqrt(std::max(0.0f, 1.0f - mu * mu)), 0.0f, mu),
          stretched(ggx_stretch(wo, alpha_)),
          alpha(alpha_),
          g1(ggx_g1(mu, alpha_)) {}
    [[nodiscard]] vec3 at(vec2 cos_sin, double height) const {
        const float depth = static_cast<float>(1.0 - height * height * height);
        return ggx_cap_normal(stretched, alpha, depth, cos_sin.x, cos_sin.y);
    }
    [[nodiscard]] float mirrored_z(vec3 h) const { return 2.0f * dot(wo, h) * h.z - wo.z; }
};
struct Angle {
    vec2 cos_sin;
    double weight;
};
/// Half a turn: by symmetry it suffices. Gauss's points crowd at its ends, where grazing views need them.
std::array<Angle, angle_points> half_turn() {
    const GaussLegendre<angle_points> rule;
    std::array<Angle, angle_points> result;
    for (std::size_t k = 0; k < angle_points; ++k) {
        const double phi = std::numbers::pi * rule.x[k];
        result[k] = {vec2(std::cos(phi), std::sin(phi)), rule.weight[k]};
    }
    return result;
}
struct Rules {
    Cap cap;
    std::array<Angle, angle_points> turn = half_turn();
};

/// The height where, at one angle, `holds` stops holding on the way down from the pole; the integral is split
/// there to keep Gauss's rule accurate.
template <class Predicate>
double boundary(const VisibleNormals& normals, vec2 cos_sin, const Predicate& holds) {
    const bool at_pole = holds(normals.at(cos_sin, 1.0));
    double below = 0.0, above = 1.0;
    for (int step = 0; step < 10; ++step) {
        const double middle = 0.5 * (above + below);
        (holds(normals.at(cos_sin, middle)) == at_pole ? above : below) = middle;
    }
    return above;
}

/// Visits the visible normals that reflect upwards: add(h, share), share the node's weight times G2/G1.
template <class Add>
void visit_reflections(const VisibleNormals& normals, const Rules& rules, const Add& add) {
    for (const auto& [cos_sin, angle_weight] : rules.turn) {
        const double lowest = boundary(normals, cos_sin, [&](vec3 h) { return normals.mirrored_z(h) > 0.0f; });
        for (std::size_t i = 0; i < rules.cap.x.size(); ++i) {
            const double height = lowest + (1.0 - lowest) * rules.cap.x[i];
            const vec3 h = normals.at(cos_sin, height);
            const float wi_z = normals.mirrored_z(h);
            if (wi_z <= 0.0f) continue;
            const double weight = rules.cap.weight[i] * (1.0 - lowest) * 3.0 * height * height * angle_weight;
            add(h, weight * ggx_g2(normals.wo.z, wi_z, normals.alpha) / normals.g1);
        }
    }
}

/// (A, B): the mean of G2/G1 (1 − (1 − o·h)⁵) and G2/G1 (1 − o·h)⁵ over the visible normals.
glm::dvec2 reflection_albedo(float mu, float alpha, const Rules& rules) {
    const VisibleNormals normals(mu, alpha);
    glm::dvec2 sum(0);
    visit_reflections(normals, rules, [&](vec3 h, double share) {
        const double fresnel = schlick_weight(dot(normals.wo, h));
        sum += glm::dvec2(1.0 - fresnel, fresnel) * share;
    });
    return sum;
}

/// Means over the visible normals (Heitz 2018, "Sampling the GGX Distribution of Visible Normals") times Fresnel's factor.
struct LobeMeans {
    double energy = 0;
    glm::dvec2 direction{0};  ///< its sum: x along the viewer's, and the normal
    double mean_square = 0;   ///< of its density
};
LobeMeans lobe_means(float mu, float alpha, float f0, const Rules& rules) {
    const VisibleNormals normals(mu, alpha);
    LobeMeans means;
    visit_reflections(normals, rules, [&](vec3 h, double unmasked) {
        const float facing = dot(normals.wo, h);
        const vec3 i = h * (2.0f * facing) - normals.wo;
        const double fresnel = f0 + (1.0 - f0) * schlick_weight(facing);
        const double share = unmasked * fresnel;
        means.energy += share;
        means.direction += share * glm::dvec2(i.x, i.z);
        means.mean_square += share * fresnel * ggx_reflection(normals.wo, i, h, alpha);
    });
    return means;
}

/// Reflection with height-correlated and refraction with separable masking, as bsdf.h has them.
double single_glass_albedo(float mu, float alpha, float eta, const Rules& rules) {
    const VisibleNormals normals(mu, alpha);
    const auto value_at = [&](vec3 h) {
        const float wi_z = normals.mirrored_z(h);
        const double fresnel = fresnel_dielectric(dot(normals.wo, h), eta);
        double value = wi_z > 0.0f ? fresnel * ggx_g2(mu, wi_z, alpha) / normals.g1 : 0.0;
        vec3 refracted;
        if (refract_about(normals.wo, h, eta, refracted) && refracted.z < 0.0f) {
            value += (1.0 - fresnel) * ggx_g1(-refracted.z, alpha);
        }
        return value;
    };
    const auto refracts = [&](vec3 h) {
        vec3 refracted;
        return refract_about(normals.wo, h, eta, refracted);
    };
    double sum = 0;
    const auto add = [&](vec2 cos_sin, double angle_weight, double begin, double end) {
        for (std::size_t i = 0; i < rules.cap.x.size(); ++i) {
            const double height = begin + (end - begin) * rules.cap.x[i];
            const double weight = rules.cap.weight[i] * (end - begin) * 3.0 * height * height * angle_weight;
            sum += weight * value_at(normals.at(cos_sin, height));
        }
    };
    for (const auto& [cos_sin, angle_weight] : rules.turn) {
        // Only from the dense side can reflection be total.
        const double middle = eta < 1.0f ? boundary(normals, cos_sin, refracts) : alpha < 0.2f ? 0.0 : 0.5;
        if (middle > 1e-3) add(cos_sin, angle_weight, 0.0, middle);
        add(cos_sin, angle_weight, middle, 1.0);
    }
    return sum;
}

/// 2 ∫ f μ dμ of one interpolated row, exactly: with x = √μ, 4 ∫ f(x) x³ dx and f linear in each cell.
glm::dvec2 reflection_average(std::span<const float> row) {
    const GaussLegendre<3> rule;
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
double glass_mu(double x, double alpha) {
    return x * alpha / (1.0 + alpha - x);
}
/// The same for a row of glass: ∫ f d(μ²), cell by cell in the row's own coordinate.
float glass_average(std::span<const float> row, double alpha) {
    const GaussLegendre<6> rule;
    const double step = 1.0 / (glass_columns - 1);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < glass_columns; ++i) {
        for (std::size_t k = 0; k < 6; ++k) {
            const double x = (i + rule.x[k]) * step, mu = glass_mu(x, alpha);
            const double slope = alpha * (1.0 + alpha) / ((1.0 + alpha - x) * (1.0 + alpha - x));
            sum += rule.weight[k] * step * 2.0 * mu * slope * glm::mix<double>(row[i], row[i + 1], rule.x[k]);
        }
    }
    return static_cast<float>(sum);
}

/// Stands for the limit at grazing incidence.
constexpr double smallest_mu = 1e-6;

void fill_reflection(std::span<float> table, const Rules& rules) {
    each_table_row(ggx_albedo_rows, [&](std::size_t j) {
        const std::span row = table.subspan(2 * j * ggx_albedo_columns, 2 * ggx_albedo_columns);
        for (std::size_t i = 0; i < ggx_albedo_columns; ++i) {
            const double x = static_cast<double>(i) / (ggx_albedo_columns - 1);
            const float mu = static_cast<float>(std::max(x * x, smallest_mu));
            const glm::dvec2 ab = reflection_albedo(mu, alpha_of_row(j, ggx_albedo_rows), rules);
            const double excess = std::max(1.0, ab.x + ab.y);  // rounding must not give more than all
            row[2 * i] = static_cast<float>(ab.x / excess);
            row[2 * i + 1] = static_cast<float>(ab.y / excess);
        }
        const glm::dvec2 average = reflection_average(row);
        table[ggx_albedo_averages + 2 * j] = static_cast<float>(average.x);
        table[ggx_albedo_averages + 2 * j + 1] = static_cast<float>(average.y);
    });
}

void fill_specular_lobes(std::span<float> table, const Rules& rules) {
    constexpr double largest_mu = 1 - 1e-5;  // stands for the limit from the normal, where the angles' ratio is 0/0
    each_table_row(specular_lobe_layers * specular_lobe_rows, [&](std::size_t row) {
        const float f0 = row < specular_lobe_rows ? 1.0f : lobe_dielectric_f0;
        const float alpha = alpha_of_row(row % specular_lobe_rows, specular_lobe_rows);
        for (std::size_t i = 0; i < specular_lobe_columns; ++i) {
            const double x = static_cast<double>(i) / (specular_lobe_columns - 1);
            const auto mu = static_cast<float>(std::clamp(x * x, smallest_mu, largest_mu));
            const LobeMeans means = lobe_means(mu, alpha, f0, rules);
            const double one_minus_cos = means.energy * means.energy / means.mean_square / (2 * std::numbers::pi);
            const std::size_t entry = specular_lobe_start + 2 * (row * specular_lobe_columns + i);
            table[entry] = static_cast<float>(std::atan2(-means.direction.x, means.direction.y) / std::acos(double(mu)));
            table[entry + 1] = static_cast<float>(std::sqrt(one_minus_cos) / alpha);
        }
    });
}

void fill_reflected_lobes(std::span<float> table, const Rules& rules) {
    constexpr double least_mu = 1e-3;  // nothing shines on a plane from lower
    each_table_row(specular_lobe_layers * reflected_lobe_rows, [&](std::size_t row) {
        const float f0 = row < reflected_lobe_rows ? 1.0f : lobe_dielectric_f0;
        const float alpha = alpha_of_row(row % reflected_lobe_rows, reflected_lobe_rows);
        for (std::size_t i = 0; i < reflected_lobe_columns; ++i) {
            const double x = static_cast<double>(i) / (reflected_lobe_columns - 1);
            const LobeMeans means = lobe_means(static_cast<float>(std::max(x * x, least_mu)), alpha, f0, rules);
            const PlaneLobe lobe = plane_lobe(means.direction / means.energy);
            const std::size_t entry = reflected_lobe_start + 3 * (row * reflected_lobe_columns + i);
            table[entry] = static_cast<float>(lobe.mean.x);
            table[entry + 1] = static_cast<float>(lobe.mean.y);
            table[entry + 2] = static_cast<float>(lobe.clamped_cosine);
        }
    });
}

double fresnel_average(float eta) {
    const GaussLegendre<32> rule;
    double sum = 0;
    for (std::size_t i = 0; i < 32; ++i) {
        sum += rule.weight[i] * 2.0 * rule.x[i] * fresnel_dielectric(static_cast<float>(rule.x[i]), eta);
    }
    return sum;
}

void fill_glass(std::span<float> table, const Rules& rules) {
    each_table_row(2 * glass_indices, [&](std::size_t k) {
        const double root = glass_largest_f0_root * static_cast<double>(k % glass_indices) / (glass_indices - 1);
        const double dense = (1.0 + root) / (1.0 - root);
        const float eta = static_cast<float>(k < glass_indices ? dense : 1.0 / dense);
        for (std::size_t j = 0; j < glass_rows; ++j) {
            const std::span row =
                table.subspan(glass_albedo_start + (k * glass_rows + j) * glass_columns, glass_columns);
            const float alpha = alpha_of_row(j, glass_rows);
            for (std::size_t i = 0; i < glass_columns; ++i) {
                const double mu = std::max(glass_mu(static_cast<double>(i) / (glass_columns - 1), alpha), smallest_mu);
                row[i] = static_cast<float>(
                    std::min(1.0, single_glass_albedo(std::min(static_cast<float>(mu), 1.0f), alpha, eta, rules)));
            }
            table[glass_average_start + k * glass_rows + j] = glass_average(row, alpha);
        }
        if (k < glass_indices) table[glass_fresnel_start + k] = static_cast<float>(fresnel_average(eta));
    });
}

std::vector<float> compute_tables() {
    std::vector<float> table(shading_table_size);
    const Rules rules;
    fill_reflection(table, rules);
    fill_glass(table, rules);
    fill_specular_lobes(table, rules);
    fill_reflected_lobes(table, rules);
    fill_extended_tables(table);
    return table;
}

}  // namespace

std::span<const float> shading_tables() {
    static const std::vector<float> table = compute_tables();
    return table;
}

}  // namespace heliodon::shading
