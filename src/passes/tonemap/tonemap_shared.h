#ifndef HELIODON_PASSES_TONEMAP_SHARED_H
#define HELIODON_PASSES_TONEMAP_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

struct TonemapConstants {
    vec4 balance_red;  // rows of the white balance; w unused
    vec4 balance_green;
    vec4 balance_blue;
    uint width;
    uint height;
    float sample_scale;  // 1 / samples in the sum
    uint curve;          // tone_curve_*
};

SHADING_END
#endif
