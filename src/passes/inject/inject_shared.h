#ifndef HELIODON_PASSES_INJECT_SHARED_H
#define HELIODON_PASSES_INJECT_SHARED_H
#include "passes/cone_trace/volume_shared.h"
SHADING_BEGIN

/// Work on the records of one cascade.
struct InjectConstants {
    VoxelGrid grid;
    uint cascade;
    uint light_first;
    uint light_count;
    uint add;  // 1: further lights, added to those before
    vec2 gather_shift;   // of diffuse_cone()
    float gather_weight; // of what is gathered now against what was before
    float padding;
};

/// Work on the occupied voxels of one level of the last cascade.
struct FilterConstants {
    uint level;      // being written or cleared
    uint size;       // voxels an edge of the cascade, level 0
    uint cascade;
    uint list_first; // of the level's voxels, in words
};

SHADING_END
#endif
