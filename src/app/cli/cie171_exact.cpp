#include "app/cli/cie171_exact.h"

#include <algorithm>
#include <cmath>

#include "shading/quadrature.h"

namespace heliodon::cli {
namespace {

/// Panels a side of each piece: with 12 points each, five digits a quarter of a metre off a window.
constexpr int panels = 8;

const shading::GaussLegendre<12>& rule() {
    static const shading::GaussLegendre<12> points;
    return points;
}

}  // namespace

double illuminance_through(const Aperture& aperture, const glm::dvec3& position, const glm::dvec3& normal,
                           const Radiance& radiance, const Transmittance& transmittance) {
    const glm::dvec3 cross = glm::cross(aperture.u, aperture.v);
    const double area = glm::length(cross);
    const glm::dvec3 facing = cross / area;
    std::vector<double> ends{0, 1};
    for (const double place : aperture.breaks)
        if (place > 0 && place < 1) ends.push_back(place);
    std::sort(ends.begin(), ends.end());
    const auto arriving = [&](double s, double t) {
        const glm::dvec3 path = aperture.corner + s * aperture.u + t * aperture.v - position;
        const double squared = glm::dot(path, path);
        const glm::dvec3 direction = path / std::sqrt(squared);
        const double received = glm::dot(direction, normal), passed = std::abs(glm::dot(direction, facing));
        if (received <= 0) return 0.0;
        return radiance(direction) * received * passed / squared * (transmittance ? transmittance(passed) : 1);
    };
    double sum = 0;
    for (std::size_t piece = 0; piece + 1 < ends.size(); ++piece) {
        const double height = (ends[piece + 1] - ends[piece]) / panels;
        for (int i = 0; i < panels * panels; ++i)
            for (std::size_t k = 0; k < rule().x.size(); ++k)
                for (std::size_t l = 0; l < rule().x.size(); ++l)
                    sum += rule().weight[k] * rule().weight[l] * height / panels *
                           arriving((i % panels + rule().x[k]) / panels, ends[piece] + (i / panels + rule().x[l]) * height);
    }
    return sum * area;
}

}  // namespace heliodon::cli
