#include "shading/extended_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "shading/fresnel.h"
#include "shading/ggx_anisotropic.h"
#include "shading/quadrature.h"
#include "shading/sheen.h"

namespace heliodon::shading {
namespace {

// Points of the quadrature: azimuths, heights above and below where light begins to be mirrored upward.
constexpr std::size_t turn_points = 32, upper_points = 8, lower_points = 6;
constexpr double smallest_mu = 1e-3;  // stands for the limit at grazing incidence

vec3 direction(double mu, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, 1 - mu * mu));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), mu};
}

template <class T>
using Turns = std::array<T, turn_points>;

/// Facets seen from `wo`, by azimuth and height of the spherical cap (Dupuy & Benyoub 2023), the height a cube as tables.cpp
/// has it; what they mirror, for all azimuths at once: component by component and without branches, as compilers like it.
class VisibleFacets {
public:
    VisibleFacets(vec3 wo, vec2 alpha, const Turns<float>& cosine, const Turns<float>& sine)
        : wo_(wo), alpha_(alpha), center_(normalize(vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z))), cosine_(cosine), sine_(sine) {}

    /// For each azimuth the height above which light is mirrored upward.
    [[nodiscard]] Turns<float> lowest() const {
        Turns<float> low{}, high, middle, up;
        high.fill(1);
        for (int step = 0; step < 12; ++step) {
            for (std::size_t k = 0; k < turn_points; ++k) middle[k] = 0.5f * (low[k] + high[k]);
            for (std::size_t k = 0; k < turn_points; ++k) {
                const Facet facet = at(k, middle[k]);
                up[k] = 2 * facet.along * facet.z - wo_.z * facet.squared;
            }
            for (std::size_t k = 0; k < turn_points; ++k) {
                high[k] = up[k] > 0 ? middle[k] : high[k];
                low[k] = up[k] > 0 ? low[k] : middle[k];
            }
        }
        return high;
    }
    /// G2/G1 at these heights, and Schlick's weights.
    void mirror(const Turns<float>& heights, Turns<float>& energies, Turns<float>& grazings) const {
        const float seen = 1.0f + ggx_lambda_stretched(wo_, alpha_);
        for (std::size_t k = 0; k < turn_points; ++k) {
            const Facet facet = at(k, heights[k]);
            const float twice = 2 * facet.along / facet.squared;
            const float x = alpha_.x * (twice * facet.x - wo_.x), y = alpha_.y * (twice * facet.y - wo_.y);
            const float z = twice * facet.z - wo_.z, above = 0.5f * (z + std::abs(z));
            // (1 + Λo)/(1 + Λo + Λi), times cos θi above and below.
            energies[k] = seen * above / ((seen - 0.5f) * above + 0.5f * std::sqrt(above * above + x * x + y * y));
            const float c = 1 - facet.along / std::sqrt(facet.squared), c2 = c * c;
            grazings[k] = c2 * c2 * c;
        }
    }

private:
    struct Facet {
        float x, y, z, squared, along;  // of any length
    };
    [[nodiscard]] Facet at(std::size_t k, float height) const {
        const float cube = height * height * height, t = (1 - cube) * (1 + center_.z), radius = std::sqrt(std::abs(t * (2 - t)));
        const float x = alpha_.x * (radius * cosine_[k] + center_.x), y = alpha_.y * (radius * sine_[k] + center_.y);
        const float z = cube * (1 + center_.z);
        return {x, y, z, x * x + y * y + z * z, wo_.x * x + wo_.y * y + wo_.z * z};
    }
    vec3 wo_;
    vec2 alpha_;
    vec3 center_;
    const Turns<float>&cosine_, &sine_;
};

/// (A, B): the mean of G2/G1 (1 − (1 − o·h)⁵) and G2/G1 (1 − o·h)⁵ over the visible normals.
class AlbedoRule {
public:
    AlbedoRule() {
        for (std::size_t k = 0; k < turn_points; ++k) {
            const double phi = 2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / turn_points;
            cosine_[k] = static_cast<float>(std::cos(phi));
            sine_[k] = static_cast<float>(std::sin(phi));
        }
    }
    [[nodiscard]] glm::dvec2 split(vec3 wo, vec2 alpha) const {
        const VisibleFacets facets(wo, alpha, cosine_, sine_);
        const Turns<float> lowest = facets.lowest();
        glm::dvec2 sum(0);
        add(facets, upper_, lowest, filled(1), sum);
        add(facets, lower_, filled(0), lowest, sum);
        return sum;
    }

private:
    static Turns<float> filled(float height) {
        Turns<float> heights;
        heights.fill(height);
        return heights;
    }
    template <std::size_t N>
    static void add(const VisibleFacets& facets, const GaussLegendre<N>& rule, const Turns<float>& begin, const Turns<float>& end, glm::dvec2& sum) {
        Turns<float> heights, energies, grazings;
        for (std::size_t i = 0; i < N; ++i) {
            const auto x = static_cast<float>(rule.x[i]);
            for (std::size_t k = 0; k < turn_points; ++k) heights[k] = begin[k] + (end[k] - begin[k]) * x;
            facets.mirror(heights, energies, grazings);
            float energy = 0, grazing = 0;
            for (std::size_t k = 0; k < turn_points; ++k) {
                const float share = 3 * heights[k] * heights[k] * (end[k] - begin[k]) * energies[k];
                energy += share;
                grazing += share * grazings[k];
            }
            sum += rule.weight[i] / turn_points * glm::dvec2(energy - grazing, grazing);
        }
    }
    GaussLegendre<upper_points> upper_;
    GaussLegendre<lower_points> lower_;
    Turns<float> cosine_, sine_;
};

/// The axes and the direction that stretched_slopes() maps to these slopes.
struct StretchedView {
    vec2 alpha;
    double azimuth;
};
StretchedView view_of_slopes(double along, double across, double shear) {
    const double product = along * along * across * across, mean = (along * along + across * across) / 2;
    const double half = (along * along - across * across) / 2, mixed = std::sqrt(product * (1 - shear));
    const double longer = mean + std::sqrt(half * half + mixed * mixed);
    constexpr double thinnest = 1e-4;  // stands for a line of slopes
    const double shorter = std::max(std::sqrt(product * shear / longer), thinnest);
    return {{std::sqrt(longer), shorter}, 0.5 * std::atan2(mixed, half)};
}

/// The lookups of ggx_albedo.h and ggx_anisotropic.h in the table while it is being filled.
struct Lookup {
    std::span<const float> table;

    [[nodiscard]] glm::dvec2 entry(std::size_t i) const { return {table[i], table[i + 1]}; }
    /// A cell's index and where in it.
    static std::pair<std::size_t, double> cell(double coordinate, std::size_t count) {
        const double place = coordinate * static_cast<double>(count - 1);
        const std::size_t first = std::min(static_cast<std::size_t>(place), count - 2);
        return {first, place - static_cast<double>(first)};
    }
    [[nodiscard]] glm::dvec2 isotropic(double mu, double alpha) const {
        const auto [j, y] = cell(alpha_coordinate(static_cast<float>(alpha)), ggx_albedo_rows);
        const auto [i, x] = cell(std::sqrt(mu), ggx_albedo_columns);
        const std::size_t low = 2 * (j * ggx_albedo_columns + i), high = low + 2 * ggx_albedo_columns;
        return glm::mix(glm::mix(entry(low), entry(low + 2), x), glm::mix(entry(high), entry(high + 2), x), y);
    }
    [[nodiscard]] glm::dvec2 stretched(vec3 w, vec2 alpha) const;
};

std::size_t stretched_entry(std::size_t row, std::size_t breadth, std::size_t shear, std::size_t column) {
    return stretched_albedo_start + 2 * (((row * stretched_breadths + breadth) * stretched_shears + shear) * stretched_columns + column);
}
glm::dvec2 Lookup::stretched(vec3 w, vec2 alpha) const {
    const vec3 slopes = stretched_slopes(w, alpha);
    const auto [j, u] = cell(alpha_coordinate(std::sqrt(slopes.x)), stretched_rows);
    const auto [b, z] = cell(alpha_coordinate(std::sqrt(slopes.y)), stretched_breadths);
    const auto [s, y] = cell(slopes.z, stretched_shears);
    const auto [i, x] = cell(std::sqrt(w.z), stretched_columns);
    glm::dvec2 sum = isotropic(w.z, std::sqrt(slopes.x));
    for (std::size_t corner = 0; corner < 16; ++corner) {
        const std::size_t dj = corner & 1, db = corner >> 1 & 1, ds = corner >> 2 & 1, di = corner >> 3;
        const double weight = (dj ? u : 1 - u) * (db ? z : 1 - z) * (ds ? y : 1 - y) * (di ? x : 1 - x);
        sum += weight * entry(stretched_entry(j + dj, b + db, s + ds, i + di));
    }
    return glm::max(sum, glm::dvec2(0));
}

void fill_stretched(std::span<float> table) {
    const AlbedoRule rule;
    const Lookup lookup{table};
    const auto fill_row = [&](std::size_t j) {
        for (std::size_t b = 0; b < stretched_breadths; ++b)
            for (std::size_t s = 0; s < stretched_shears; ++s) {
                const double along = alpha_of_row(j, stretched_rows), across = alpha_of_row(b, stretched_breadths);
                const StretchedView view = view_of_slopes(along, across, static_cast<double>(s) / (stretched_shears - 1));
                for (std::size_t i = 0; i < stretched_columns; ++i) {
                    const double x = static_cast<double>(i) / (stretched_columns - 1), mu = std::max(x * x, smallest_mu);
                    glm::dvec2 split = rule.split(direction(mu, view.azimuth), view.alpha);
                    split /= std::max(1.0, split.x + split.y);  // rounding must not give more than all
                    const glm::dvec2 more = split - lookup.isotropic(mu, along);
                    table[stretched_entry(j, b, s, i)] = static_cast<float>(more.x);
                    table[stretched_entry(j, b, s, i) + 1] = static_cast<float>(more.y);
                }
            }
    };
    each_table_row(stretched_rows, fill_row);
}

/// 2/π ∫∫ E μ dμ dφ over a quarter turn of what the lookup returns.
void fill_averages(std::span<float> table) {
    const GaussLegendre<20> cosines;
    constexpr std::size_t turns = 16;
    const Lookup lookup{table};
    each_table_row(stretched_averages, [&](std::size_t j) {
        for (std::size_t i = 0; i <= j; ++i) {
            const vec2 alpha(alpha_of_row(i, stretched_averages), alpha_of_row(j, stretched_averages));
            glm::dvec2 sum(0);
            for (std::size_t k = 0; k < cosines.x.size(); ++k)
                for (std::size_t t = 0; t < turns; ++t) {
                    const double azimuth = 0.5 * std::numbers::pi * (static_cast<double>(t) + 0.5) / turns;
                    sum += cosines.weight[k] * 2 * cosines.x[k] / turns * lookup.stretched(direction(cosines.x[k], azimuth), alpha);
                }
            for (const std::size_t entry : {j * stretched_averages + i, i * stretched_averages + j}) {
                table[stretched_average_start + 2 * entry] = static_cast<float>(sum.x);
                table[stretched_average_start + 2 * entry + 1] = static_cast<float>(sum.y);
            }
        }
    });
}

void fill_sheen(std::span<float> table) {
    const GaussLegendre<32> cosines;
    constexpr std::size_t turns = 24;
    each_table_row(sheen_rows, [&](std::size_t j) {
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
    });
}

}  // namespace

void each_table_row(std::size_t rows, const std::function<void(std::size_t row)>& fill) {
    // A number of threads, since these threads then take no other work: that might wait for the tables.
    constexpr int most_threads = 64;
    parallel_for(rows, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) fill(row);
    }, most_threads);
}

void fill_extended_tables(std::span<float> table) {
    fill_stretched(table);
    fill_averages(table);
    fill_sheen(table);
}

}  // namespace heliodon::shading
