#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "shading/bsdf.h"

namespace heliodon::tests {

/// Point `i` of a low-discrepancy sequence in the unit cube: Roberts 2018, "The Unreasonable Effectiveness of
/// Quasirandom Sequences" (its constant is the real root of x⁴ = x + 1).
inline glm::vec3 cube_point(std::uint32_t i) {
    const double g = 1.22074408460575947536;
    const double n = i + 0.5;
    const auto part = [](double x) { return static_cast<float>(std::min(x - std::floor(x), 0.99999994)); };
    return {part(n / g), part(n / (g * g)), part(n / (g * g * g))};
}

inline glm::vec3 direction(float mu, float azimuth = 0.0f) {
    const float sine = std::sqrt(std::max(0.0f, 1.0f - mu * mu));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), mu};
}

/// ∫ f |cos θ| dω by importance sampling, without radiance's 1/eta² on refraction: the part of the
/// incident energy that comes back.
inline glm::dvec3 returned_energy(const shading::Surface& surface, glm::vec3 wo, std::uint32_t samples) {
    const shading::BsdfLobes lobes = shading::bsdf_prepare(surface, wo);
    glm::dvec3 sum(0);
    for (std::uint32_t i = 0; i < samples; ++i) {
        const shading::BsdfSample sample = shading::bsdf_sample_prepared(surface, lobes, wo, cube_point(i));
        if (sample.pdf > 0.0f) sum += glm::dvec3(sample.weight / sample.eta_scale);
    }
    return sum / static_cast<double>(samples);
}

inline shading::Surface standard_surface(glm::vec3 base_color, float metallic, float roughness) {
    shading::Surface surface = shading::surface_default();
    surface.base_color = base_color;
    surface.metallic = metallic;
    surface.roughness = roughness;
    return surface;
}

inline shading::Surface glass_surface(float roughness, float ior, bool inside) {
    shading::Surface surface = standard_surface(glm::vec3(1.0f), 0.0f, roughness);
    surface.transmission = 1.0f;
    surface.ior = ior;
    surface.inside = inside;
    return surface;
}

}  // namespace heliodon::tests
