#include "scene/light.h"

#include <cmath>

#include "core/units.h"

namespace heliodon {

double flux_per_candela(const Light& light) {
    constexpr double pi = std::numbers::pi;
    switch (light.type) {
        case LightType::point:
            return light.lambertian ? pi : 4.0 * pi;
        case LightType::spot: {
            // Full intensity inside the inner cone, then ∫ ((cos θ − co)/(ci − co))² 2π d(cos θ) = 2π (ci − co)/3:
            // the squared falloff of KHR_lights_punctual (Khronos 2018, "Inner and Outer Cone Angles").
            const double cos_inner = std::cos(static_cast<double>(light.inner_rad));
            const double cos_outer = std::cos(static_cast<double>(light.outer_rad));
            return 2.0 * pi * ((1.0 - cos_inner) + (cos_inner - cos_outer) / 3.0);
        }
        case LightType::luminaire:
            return light.luminaire && light.luminaire->peak_cd > 0 ? light.luminaire->flux_lm / light.luminaire->peak_cd : 0.0;
        case LightType::directional:
            return 0.0;
    }
    return 0.0;
}

double flux_lm(const Light& light) {
    return units::luminance(glm::dvec3(light.intensity)) * flux_per_candela(light);
}

}  // namespace heliodon
