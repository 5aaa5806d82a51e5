#pragma once

#include <cstdint>
#include <memory>

#include "core/math.h"
#include "scene/luminaire.h"

namespace heliodon {

enum class LightType : std::uint8_t { point, spot, directional, luminaire };

/// A light of a node: it stands at the node's origin and aims along the node's −Z (luminaires: nadir is −Y, C0 is
/// +X). Physical units, linear Rec. 709; 0.2126 R + 0.7152 G + 0.0722 B is the photometric value.
struct Light {
    LightType type = LightType::point;
    /// point, spot: intensity in cd (on axis); directional: illuminance in lux on a plane facing it; luminaire: its
    /// peak, to which the measured intensities are scaled.
    glm::vec3 intensity{0.0f};
    bool lambertian = false;  ///< point: cosine emitter along −Z (intensity is on axis)
    float inner_rad = 0.0f;   ///< spot: half-angles
    float outer_rad = 0.7853982f;
    float radius_m = 0.0f;                   ///< point, spot: a sphere of this radius (soft shadows)
    float angular_diameter_rad = 0.0f;       ///< directional
    glm::vec3 direction{0.0f, 0.0f, -1.0f};  ///< directional: the way light travels, in the node's space
    float range_m = 0.0f;                    ///< KHR_lights_punctual's range, a hint only; 0 = unlimited
    std::shared_ptr<const Luminaire> luminaire = nullptr;  ///< luminaire; lights of one file share it
};

/// Flux in lumen: the luminous intensity (0.2126 R + 0.7152 G + 0.0722 B) times flux_per_candela.
[[nodiscard]] double flux_lm(const Light& light);
/// Flux in lumen of the same light per candela of on-axis intensity: point 4π, Lambertian π, spot exact
/// for the squared falloff, luminaire measured; 0 for directional lights.
[[nodiscard]] double flux_per_candela(const Light& light);

}  // namespace heliodon
