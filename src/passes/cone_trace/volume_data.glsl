// Where the voxel volume lies, and what is asked of its cones.
#ifndef HELIODON_VOLUME_DATA_GLSL
#define HELIODON_VOLUME_DATA_GLSL
#include "passes/cone_trace/volume_shared.h"

layout(set = 0, binding = 21, std140) uniform Volume_ { VolumeData volume; };

#endif
