// Unit vectors as two numbers.
#ifndef HELIODON_SHADING_OCTAHEDRAL_H
#define HELIODON_SHADING_OCTAHEDRAL_H
#include "shading/language.h"
SHADING_BEGIN

/// Unit vector to [−1, 1]²: Cigolle et al. 2014, "A Survey of Efficient Representations for Independent
/// Unit Vectors", listing 1.
SHADING_FN vec2 octahedral_encode(vec3 v) {
    float scale = 1.0f / (abs(v.x) + abs(v.y) + abs(v.z));
    vec2 p = vec2(v.x * scale, v.y * scale);
    if (v.z > 0.0f) {
        return p;
    }
    return vec2((1.0f - abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f), (1.0f - abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f));
}
SHADING_FN vec3 octahedral_decode(vec2 e) {
    float z = 1.0f - abs(e.x) - abs(e.y);
    float x = e.x;
    float y = e.y;
    if (z < 0.0f) {
        x = (1.0f - abs(e.y)) * (e.x >= 0.0f ? 1.0f : -1.0f);
        y = (1.0f - abs(e.x)) * (e.y >= 0.0f ? 1.0f : -1.0f);
    }
    return normalize(vec3(x, y, z));
}

SHADING_END
#endif
