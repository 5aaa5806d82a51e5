#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace heliodon::shading {

/// Nodes and weights of Gauss & Legendre's rule on [0, 1], exact for polynomials of degree 2N − 1.
template <std::size_t N>
struct GaussLegendre {
    std::array<double, N> x{}, weight{};

    GaussLegendre() {
        // Newton's iteration on the Legendre polynomial, from Tricomi's estimate of its roots.
        for (std::size_t i = 0; i < N; ++i) {
            double z = std::cos(std::numbers::pi * (i + 0.75) / (N + 0.5));
            double derivative = 1;
            for (int iteration = 0; iteration < 12; ++iteration) {
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

}  // namespace heliodon::shading
