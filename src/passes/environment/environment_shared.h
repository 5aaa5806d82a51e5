#ifndef HELIODON_PASSES_ENVIRONMENT_SHARED_H
#define HELIODON_PASSES_ENVIRONMENT_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

struct EnvironmentConstants {
    uint source;  // bindless slot of the equirectangular sky
    uint width;   // of the map being written
    uint height;
    float roughness;  // specular maps
    uint samples;
};

SHADING_END
#endif
