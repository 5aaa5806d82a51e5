#include "trace/direction_guide.h"

#include <algorithm>
#include <cmath>

namespace heliodon::trace {
namespace {

using shading::vec2;
using shading::vec3;

constexpr double even_share = 0.2;  // of guided samples: bounds the weight of a direction that the pilot missed at 5

/// Each cell's mean with its neighbours, by the binomial weights 1, 2, 1 along both axes; azimuth goes round. A border
/// of light that passes through a cell need not have met one of its few pilot paths.
std::vector<double> smoothed(int side, std::span<const double> light) {
    std::vector<double> result(light.size());
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            double sum = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int y = std::clamp(row + dy, 0, side - 1), x = (column + dx + side) % side;
                    sum += (2 - std::abs(dx)) * (2 - std::abs(dy)) * light[static_cast<std::size_t>(y) * side + x];
                }
            result[static_cast<std::size_t>(row) * side + column] = sum / 16;
        }
    return result;
}

/// The first of `cumulative` beyond `u`, and where in its step u lies.
int search(std::span<const float> cumulative, float& u) {
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u);
    const float low = found == cumulative.begin() ? 0.0f : *(found - 1);
    u = std::clamp((u - low) / std::max(*found - low, 1e-30f), 0.0f, 1.0f - 0x1p-24f);
    return static_cast<int>(found - cumulative.begin());
}

}  // namespace

DirectionGuide::DirectionGuide(int side, std::span<const double> light, double share) : side_(side) {
    std::vector<double> weights = smoothed(side, light);
    double total = 0;
    for (const double weight : weights) total += weight;
    const double cells = static_cast<double>(weights.size());
    const double guided = total > 0 && std::isfinite(total) ? (1 - even_share) * share : 0;
    for (double& weight : weights) weight = (guided > 0 ? guided * weight / total : 0) + (1 - guided) / cells;
    double running = 0;
    for (int row = 0; row < side; ++row) {
        const double* first = &weights[static_cast<std::size_t>(row) * side];
        double in_row = 0, row_sum = 0;
        for (int column = 0; column < side; ++column) row_sum += first[column];
        running += row_sum;
        rows_.push_back(row + 1 == side ? 1.0f : static_cast<float>(running));
        for (int column = 0; column < side; ++column) {
            in_row += first[column];
            columns_.push_back(column + 1 == side ? 1.0f : static_cast<float>(in_row / row_sum));
        }
    }
}

vec3 DirectionGuide::direction_in(int side, int column, int row, vec2 within) {
    const float azimuth = 2 * shading::pi * (static_cast<float>(column) + within.x) / static_cast<float>(side);
    const float sin2 = std::min((static_cast<float>(row) + within.y) / static_cast<float>(side), 1.0f);
    const float sine = std::sqrt(sin2);
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), std::sqrt(1 - sin2)};
}

float DirectionGuide::cell_density(int column, int row) const {
    const float* columns = &columns_[static_cast<std::size_t>(row) * side_];
    const float row_share = rows_[row] - (row > 0 ? rows_[row - 1] : 0.0f);
    const float column_share = columns[column] - (column > 0 ? columns[column - 1] : 0.0f);
    return row_share * column_share * static_cast<float>(side_ * side_);
}

DirectionGuide::Sampled DirectionGuide::sample(vec2 u) const {
    const int row = search(rows_, u.y);
    const int column = search(std::span(columns_).subspan(static_cast<std::size_t>(row) * side_, side_), u.x);
    const vec3 direction = direction_in(side_, column, row, u);
    return {direction, cell_density(column, row) * shading::cosine_hemisphere_pdf(direction.z)};
}

float DirectionGuide::pdf(vec3 local) const {
    if (local.z <= 0) return 0;
    const float turn = std::atan2(local.y, local.x) * (0.5f * shading::inverse_pi);
    const auto cell = [this](float x) { return std::clamp(static_cast<int>(x * static_cast<float>(side_)), 0, side_ - 1); };
    const int column = cell(turn < 0 ? turn + 1 : turn), row = cell(local.x * local.x + local.y * local.y);
    return cell_density(column, row) * shading::cosine_hemisphere_pdf(local.z);
}

}  // namespace heliodon::trace
