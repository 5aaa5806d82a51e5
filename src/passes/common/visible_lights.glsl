// Lights with an extent as the camera sees them. They are no surfaces: they shine through one another and hide
// nothing.
#ifndef HELIODON_VISIBLE_LIGHTS_GLSL
#define HELIODON_VISIBLE_LIGHTS_GLSL
#include "passes/common/luminaires.glsl"

layout(set = 0, binding = 16, std430) readonly buffer VisibleLights {
    uint visible_light_count;
    uint visible_light_padding0;
    uint visible_light_padding1;
    uint visible_light_padding2;
    LightData visible_lights[];
};

const float beyond_every_light = 2.0f * light_distance_infinite;

/// Radiance of the lights that the ray meets within `distance` metres. `direction` is unit.
vec3 lights_seen(vec3 origin, vec3 direction, float distance) {
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; has_visible_lights && i < visible_light_count; ++i) {
        const LightData light = visible_lights[i];
        const float t = scene_light_intersect(light, origin, direction);
        if (t >= 0.0f && t < distance) sum += scene_light_radiance(light, direction);
    }
    return sum;
}

#endif
