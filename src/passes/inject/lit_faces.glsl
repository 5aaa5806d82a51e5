// The faces of a cascade that show a surface which reflects light; the others are never lit.
#ifndef HELIODON_LIT_FACES_GLSL
#define HELIODON_LIT_FACES_GLSL
#include "passes/inject/inject_shared.h"
#include "passes/voxelize/linear_groups.glsl"
#include "passes/voxelize/voxel_record.glsl"

layout(set = 0, binding = 16, std430) readonly buffer Numbers { VoxelHeader voxel_header; };
layout(set = 0, binding = 25, std430) readonly buffer LitFaces { LitFacesHeader lit_header; uint lit_records[]; };

/// The record of entry `place` in a face's list; false past its end. `enclosed`: within a solid, where only lights reach it.
bool lit_record(uint face, uint place, out uint record, out bool enclosed) {
    record = 0u;
    enclosed = false;
    if (place >= lit_header.groups[face].w) return false;
    const uint entry = lit_records[face * voxel_header.record_count + place];
    record = entry & ~lit_record_enclosed;
    enclosed = entry != record;
    return true;
}

#endif
