// One invocation a record of a cascade.
#ifndef HELIODON_RECORD_WORK_GLSL
#define HELIODON_RECORD_WORK_GLSL
#include "passes/inject/inject_shared.h"
#include "passes/voxelize/linear_groups.glsl"
#include "passes/voxelize/voxel_record.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, std430) readonly buffer Numbers { VoxelHeader voxel_header; uint voxel_number[]; };

/// In the texture of all faces.
ivec3 face_texel(uvec3 voxel, uint face, uint size, uint cascade) {
    return ivec3(voxel) + int(size) * ivec3(int(face & 1u), int(cascade), int(face >> 1u));
}

#endif
