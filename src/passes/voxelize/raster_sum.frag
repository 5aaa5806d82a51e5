#version 460
#extension GL_GOOGLE_include_directive : require
// Sums the records that a triangle passes through in a pixel's column.
#include "passes/voxelize/voxel_shared.h"

layout(set = 0, binding = 16, std430) readonly buffer Numbers { VoxelHeader header; uint voxel_number[]; };
layout(set = 0, binding = 18, std430) buffer Records { uint records[]; };

uint face_sums(uint face) { return face * voxel_field_count; }
void add_to_sum(uint place, uint amount) { atomicAdd(records[place], amount); }
#include "passes/voxelize/voxel_sum.glsl"
#include "passes/voxelize/voxel_column.glsl"

void main() {
    VoxelTriangle triangle;
    if (!column_of_fragment(triangle)) return;
    ivec3 voxel = triangle.low;
    do {
        const uint number = voxel_number[voxel_place(voxel)];
        if (number != 0u && number != voxel_without_room && near_plane(triangle, voxel))
            sum(triangle, voxel, number - 1u, 0u);
    } while (next_voxel(triangle, voxel));
}
