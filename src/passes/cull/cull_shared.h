#ifndef HELIODON_PASSES_CULL_SHARED_H
#define HELIODON_PASSES_CULL_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

SHADING_CONST uint cull_group_size = 64u;

struct CullConstants {
    uint instance_count;
    uint list_capacity;    // commands a draw list can hold
    uint merge_blended;    // 1: blended surfaces join the alpha-tested list (shadow views)
    uint padding;
};

SHADING_END
#endif
