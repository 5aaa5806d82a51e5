#ifndef HELIODON_PASSES_ENVIRONMENT_SHARED_H
#define HELIODON_PASSES_ENVIRONMENT_SHARED_H
#include "shading/scene_data.h"
SHADING_BEGIN

struct EnvironmentConstants {
    uint source;  // bindless slot of the equirectangular sky
    uint width;   // of the map being written
    uint height;
    float roughness;  // specular maps
    uint samples;
};

struct SkyPictureConstants {
    uint width;  // of the level being written
    uint height;
};

SHADING_END
#endif
