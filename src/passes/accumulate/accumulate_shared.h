#ifndef HELIODON_PASSES_ACCUMULATE_SHARED_H
#define HELIODON_PASSES_ACCUMULATE_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

struct AccumulateConstants {
    uint width;
    uint height;
    uint replace;  // 1: the sum starts anew with this contribution
};

SHADING_END
#endif
