// How far a cone can go before it can meet anything, in C++ and GLSL (docs/gi-theory.md).
#ifndef HELIODON_PASSES_EMPTY_CUBES_SHARED_H
#define HELIODON_PASSES_EMPTY_CUBES_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

// The lattice is cut into cells of 4³ of its widest cascade's voxels, the texels of level 2. Each has a word of eight
// times four bits, the step of the largest cube of cells that begins with this one, extends to one of eight sides (bit a
// of the octant: towards smaller a) and shows nothing to those who go there.
SHADING_CONST uint cube_cell_level = 2u;
SHADING_CONST uint largest_cube_step = 14u;

/// Edges of the cubes, in cells: 0 1 2 3 4 6 8 12 … 128.
SHADING_FN uint cube_edge(uint step) {
    return step < 2u ? step : (step % 2u == 0u ? 2u : 3u) << (step / 2u - 1u);
}

struct EmptyCubesConstants {
    uint size;       // cells an edge
    uint first_row;  // texels before the widest cascade's faces, along y
    uint step;       // 1: which cells show nothing; from 2: which cubes of this step are empty
    uint padding;
};

SHADING_END
#endif
