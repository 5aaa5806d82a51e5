// The intensities of luminaires, and with them what any light sends.
#ifndef HELIODON_LUMINAIRES_GLSL
#define HELIODON_LUMINAIRES_GLSL
#include "shading/luminaire_shape.h"

layout(set = 0, binding = 26, std430) readonly buffer LuminaireTable { float luminaire_table[]; };
float luminaire_value(uint i) { return luminaire_table[i]; }

#include "shading/luminaire.h"

// Scenes without luminaires have no code for them.
layout(constant_id = 10) const bool has_luminaires = false;

/// Luminaires with an extent come as one of their points.
LightSample scene_light_sample(LightData light, vec3 point, vec2 u) {
    if (has_luminaires && light.type == light_type_luminaire) return luminaire_point_sample(light, point);
    return light_sample(light, point, u);
}
float scene_light_intersect(LightData light, vec3 origin, vec3 direction) {
    if (has_luminaires) return any_light_intersect(light, origin, direction);
    return light_intersect(light, origin, direction);
}
vec3 scene_light_radiance(LightData light, vec3 direction) {
    if (has_luminaires) return any_light_radiance(light, direction);
    return light_radiance(light, direction);
}

#endif
