#ifndef HELIODON_PASSES_AMBIENT_OCCLUSION_SHARED_H
#define HELIODON_PASSES_AMBIENT_OCCLUSION_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

struct AmbientOcclusionConstants {
    float reach_m;      // how far away something still hides; 0: as far as the picture shows
    float thickness_m;  // how far what is seen goes on behind its front; 0: without end
    uint slices;        // planes through the viewer's direction
    uint steps;         // along each half of a slice
};

SHADING_END
#endif
