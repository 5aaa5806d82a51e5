// How likely each light of a batch is picked in each cell of a grid over the scene, in C++ and GLSL.
#ifndef HELIODON_LIGHT_GRID_SHARED_H
#define HELIODON_LIGHT_GRID_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

/// So many lights are summed one by one; of more, some are picked.
SHADING_CONST uint most_lights_summed = 32u;

/// First words of the grid's buffer. sums[light][cell] follow, cell = x + edge (y + edge z): lights of the batch up to
/// and with this one are picked with a chance of sum / (the last light's sum).
struct LightGridHeader {
    vec3 origin;
    uint edge;         // cells
    vec3 cell_m;
    uint light_first;  // of the batch, among the lights that shine
    uint light_count;
    uint padding0;
    uint padding1;
    uint padding2;
};

SHADING_END
#endif
