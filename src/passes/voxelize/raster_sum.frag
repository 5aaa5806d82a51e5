#version 460
#extension GL_GOOGLE_include_directive : require
// Sums the records that a triangle passes through in a pixel's column.
#include "passes/voxelize/voxel_shared.h"

layout(set = 0, binding = 16, std430) readonly buffer Numbers { VoxelHeader header; uint voxel_number[]; };
layout(set = 0, binding = 18, std430) buffer Records { uint records[]; };

struct VoxelSums {
    uint first;
    uint stride;
};
VoxelSums find_sums(uint record) { return VoxelSums(record * voxel_faces * voxel_field_count, voxel_field_count); }
void add_to_record(uint word, uint amount) { atomicAdd(records[word], amount); }
void add_to_sum(uint place, uint amount) { add_to_record(place, amount); }
#include "passes/voxelize/voxel_sum.glsl"
#include "passes/voxelize/voxel_column.glsl"

void main() {
    VoxelTriangle triangle;
    if (!column_of_fragment(triangle)) return;
    ivec3 voxel = triangle.low;
    do {
        const uint number = voxel_number[voxel_place(voxel)];
        if (number != 0u && number != voxel_without_room && near_plane(triangle, voxel))
            sum(triangle, voxel, number - 1u);
    } while (next_voxel(triangle, voxel));
}
