// How far cones may go before anything shows itself to them, in C++ and GLSL (docs/gi-theory.md).
#ifndef HELIODON_PASSES_OCCUPANCY_SHARED_H
#define HELIODON_PASSES_OCCUPANCY_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

// Each texel of the volume that has a face there has a byte: bit 2 axis + side is set if the face of that axis and side
// covers anything in the texel or in one of those beside it across the axis, which linear interpolation mixes in. Four
// texels along x share a word. Of n³ voxels first come those of each cascade, then the filtered levels of the widest one
// as long as they have four texels an edge.
SHADING_CONST uint fewest_occupancy_texels = 4u;

/// Words before those of level `mip` of cascade `cascade`, n = voxels an edge.
SHADING_FN uint occupancy_first(uint n, uint cascade, uint mip) {
    uint size = n >> mip;
    return cascade * (n * n * n / 4u) + (n * n * n - size * size * size) / 7u * 2u;  // n³/4 (1 + 1/8 + …)
}
SHADING_FN uint occupancy_levels(uint n) {
    uint levels = 0u;
    while ((n >> levels) >= fewest_occupancy_texels) ++levels;
    return levels;
}

// Of these bytes each voxel of each cascade keeps, four bits a face, how many levels from its own on are empty where it lies.
SHADING_CONST uint emptiness_bits = 4u;

/// Work on the emptiness of a cascade.
struct EmptinessConstants {
    ivec3 base;        // VolumeCascade.base
    uint size;         // voxels an edge
    ivec3 outer_base;  // of the next cascade
    uint cascade;
    uint widest;       // 1: there is no next one, but levels
};

SHADING_END
#endif
