#pragma once

#include <vector>

#include "quadrature_points.h"
#include "shading/fresnel.h"

namespace heliodon::tests {

struct NamedSurface {
    const char* name;
    shading::Surface surface;
};

inline shading::Surface extended_surface(glm::vec3 base_color, float metallic, float roughness) {
    shading::Surface surface = standard_surface(base_color, metallic, roughness);
    surface.extended = true;
    return surface;
}
inline shading::Surface disney_surface(glm::vec3 base_color, float metallic, float roughness) {
    shading::Surface surface = extended_surface(base_color, metallic, roughness);
    surface.model = shading::material_model_disney;
    surface.specular = 0.5f;
    return surface;
}
inline shading::Surface stretched_surface(glm::vec3 base_color, float metallic, float roughness, float anisotropy) {
    shading::Surface surface = extended_surface(base_color, metallic, roughness);
    surface.anisotropy = anisotropy;
    return surface;
}
inline shading::Surface sheet_surface(float roughness, float ior) {
    shading::Surface surface = extended_surface(glm::vec3(1), 0, roughness);
    surface.transmission = 1;
    surface.thin_walled = true;
    surface.ior = ior;
    return surface;
}
inline shading::Surface film_surface(glm::vec3 base_color, float metallic, float roughness, float thickness_nm) {
    shading::Surface surface = extended_surface(base_color, metallic, roughness);
    surface.iridescence = 1;
    surface.film_thickness_nm = thickness_nm;
    return surface;
}
inline shading::Surface sheen_surface(glm::vec3 base_color, glm::vec3 color, float roughness) {
    shading::Surface surface = extended_surface(base_color, 0, 0.8f);
    surface.sheen_color = color;
    surface.sheen_roughness = roughness;
    return surface;
}
inline shading::Surface conductor_surface(glm::vec3 eta, glm::vec3 k, float roughness) {
    shading::Surface surface = extended_surface(glm::vec3(0), 1, roughness);
    surface.conductor = true;
    surface.eta = eta;
    surface.k = k;
    for (int c = 0; c < 3; ++c) {
        surface.base_color[c] = shading::fresnel_conductor(1, eta[c], k[c]);
        for (int i = 0; i < 64; ++i) {
            const float mu = (static_cast<float>(i) + 0.5f) / 64;
            surface.conductor_average[c] += 2 * mu * shading::fresnel_conductor(mu, eta[c], k[c]) / 64;
        }
    }
    return surface;
}
inline shading::Surface rough_diffuse_surface(glm::vec3 base_color, float roughness, float sigma) {
    shading::Surface surface = extended_surface(base_color, 0, roughness);
    surface.model = shading::material_model_oren_nayar;
    surface.sigma = sigma;
    return surface;
}

/// One of each model and layer, of middling roughness.
inline std::vector<NamedSurface> extended_surfaces() {
    std::vector<NamedSurface> cases = {
        {"disney", disney_surface({0.65f, 0.41f, 0.02f}, 0, 0.5f)},
        {"disney of everything", disney_surface({0.6f, 0.4f, 0.2f}, 0.3f, 0.6f)},
        {"rough diffuse", rough_diffuse_surface({0.8f, 0.5f, 0.2f}, 0.8f, -1)},
        {"Oren and Nayar", rough_diffuse_surface({0.8f, 0.5f, 0.2f}, 1, 0.4f)},
        {"gold", conductor_surface({0.14f, 0.36f, 1.4f}, {3.6f, 2.7f, 1.9f}, 0.5f)},
        {"brushed metal", stretched_surface({0.9f, 0.6f, 0.4f}, 1, 0.4f, 0.7f)},
        {"brushed plastic", stretched_surface({0.5f, 0.5f, 0.5f}, 0, 0.5f, 0.5f)},
        {"brushed coated glass", stretched_surface({0.5f, 0.7f, 0.5f}, 0.2f, 0.5f, 0.5f)},
        {"cloth", sheen_surface({0.3f, 0.1f, 0.1f}, {0.8f, 0.7f, 0.6f}, 0.4f)},
        {"oily metal", film_surface({0.5f, 0.5f, 0.5f}, 1, 0.5f, 400)},
        {"oily plastic", film_surface({0.3f, 0.3f, 0.3f}, 0, 0.5f, 500)},
        {"sheet", sheet_surface(0.5f, 1.5f)},
        {"sheet of a bubble", sheet_surface(0.4f, 1.33f)},
    };
    shading::Surface& everything = cases[1].surface;
    everything.subsurface = 0.4f;
    everything.anisotropy = 0.8f;
    everything.sheen = 1;
    everything.specular_tint = 0.5f;
    everything.clearcoat = 1;
    everything.clearcoat_gloss = 0.1f;
    cases[7].surface.transmission = 0.6f;
    cases[7].surface.clearcoat = 0.7f;
    cases[7].surface.clearcoat_roughness = 0.4f;
    cases[12].surface.iridescence = 1;
    cases[12].surface.film_thickness_nm = 350;
    return cases;
}

}  // namespace heliodon::tests
