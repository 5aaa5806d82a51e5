#ifndef HELIODON_PASSES_TONEMAP_SHARED_H
#define HELIODON_PASSES_TONEMAP_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

struct TonemapConstants {
    uint width;
    uint height;
    float scale;  // exposure / number of samples in the sum
};

SHADING_END
#endif
