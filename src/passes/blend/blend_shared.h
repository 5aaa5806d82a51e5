#ifndef HELIODON_PASSES_BLEND_SHARED_H
#define HELIODON_PASSES_BLEND_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

/// One blended fragment: a node of its pixel's list.
struct BlendFragment {
    uint instance;
    uint triangle;
    float depth;  // reversed: nearer is larger
    uint next;    // index + 1; 0 ends the list
};

SHADING_END
#endif
