// Without global illumination: what stands for the light that surroundings reflect (shading/ambient.h), in C++ and GLSL.
#ifndef HELIODON_PASSES_AMBIENT_SHARED_H
#define HELIODON_PASSES_AMBIENT_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

/// A directional light, shadows left aside.
struct AmbientLightData {
    vec3 axis;  // unit; the way light travels
    uint padding0;
    vec3 illuminance;  // lux, normal to it
    uint padding1;
};
struct AmbientData {
    vec3 albedo;  // of the shell
    uint kind;    // ambient_…
    uint sky_slot;  // what a shell of albedo 1 reflects of the sky: irradiance / π by the normal turned round; or no_texture
    uint light_count;
    uint in_the_open;  // 1: all of it is added where nothing hides the sky, or nothing tells what does; 0: none of it there
    uint padding0;
};

SHADING_END
#endif
