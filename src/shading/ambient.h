// Light that surroundings reflect, without tracing any: an approximation. The scene stands in the middle of a distant
// closed shell that reflects an even share ρ of light diffusely; the sun and the sky light it from within as if it were
// not in their way, and the scene gets what it reflects once. Nothing of it is tuned; docs/sky.md derives it.
#ifndef HELIODON_SHADING_AMBIENT_H
#define HELIODON_SHADING_AMBIENT_H
#include "shading/sampling.h"
SHADING_BEGIN

SHADING_CONST uint ambient_none = 0u;
SHADING_CONST uint ambient_constant = 1u;
SHADING_CONST uint ambient_directional = 2u;

/// ∫ max(0, a·ω) max(0, b·ω) dω over all directions, `cosine` = a·b: with A the angle between them,
/// ⅔ (sin A + (π − A) cos A), the arc-cosine kernel of degree 1 (Cho & Saul 2009, "Kernel Methods for Deep Learning",
/// eq. 6) on the sphere: their mean over Gaussian vectors times 4π / 3.
SHADING_FN float cosines_product(float cosine) {
    float c = clamp(cosine, -1.0f, 1.0f);
    return (2.0f / 3.0f) * (sqrt(max(0.0f, 1.0f - c * c)) + (pi - acos(c)) * c);
}

/// Irradiance / π on a face from a shell of reflectance 1 in the light of 1 lux (normal to it) that travels along t, at
/// `cosine` to the face's normal: the shell in the direction ω is lit at the cosine max(0, ω·t), and reflects that / π.
SHADING_FN float shell_reflected(float cosine) {
    return cosines_product(cosine) * (inverse_pi * inverse_pi);
}
/// Its mean over all normals, which is the shell's mean radiance: a quarter of the light's illuminance / π.
SHADING_CONST float shell_reflected_mean = 0.25f * 0.318309886183791f;
/// Radiance of the shell where one looks in a direction at `cosine` to the light's way.
SHADING_FN float shell_radiance(float cosine) {
    return inverse_pi * max(cosine, 0.0f);
}

SHADING_END
#endif
