#ifndef HELIODON_PASSES_ENVIRONMENT_SHARED_H
#define HELIODON_PASSES_ENVIRONMENT_SHARED_H
#include "shading/scene_data.h"
SHADING_BEGIN

struct EnvironmentConstants {
    uint width;  // of the map being written
    uint height;
    float roughness;  // specular maps
    uint even;        // irradiance maps: the mean over all directions instead, whatever the normal
};

struct SkyPictureConstants {
    uint width;  // of the level being written
    uint height;
};

SHADING_END
#endif
