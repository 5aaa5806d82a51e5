#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers the voxels that are carried from other surfaces, as far as they lie in the grid; prepare.comp copies them.
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, std430) buffer Numbers { VoxelHeader header; uint voxel_number[]; };
layout(set = 0, binding = 17, std430) writeonly buffer Cells { uint record_cell[]; };
layout(set = 0, binding = 18, std430) writeonly buffer Sources { uint source[]; };
layout(set = 0, binding = 19, std430) readonly buffer CarriedNumbers { VoxelHeader carried; };
layout(set = 0, binding = 20, std430) readonly buffer CarriedCells { uint carried_cell[]; };
layout(push_constant) uniform Push { VoxelizeConstants push; };

void main() {
    const uint from = linear_invocation();
    if (from == 0u) {
        header.carried_without_room = carried.carried_without_room + carried.record_demand - carried.record_count;
        header.carried_tile_demand = max(carried.carried_tile_demand, carried.tile_demand);
    }
    if (from >= carried.record_count) return;
    const int size = int(push.grid.size);
    const int cell = int(carried_cell[from]);
    const ivec3 voxel = ivec3(cell % size, cell / size % size, cell / (size * size)) - push.shift;
    if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, ivec3(size)))) return;
    const uint place = uint(voxel.x + size * (voxel.y + size * voxel.z));
    const uint record = atomicAdd(header.record_demand, 1u);
    record_cell[record] = place;
    voxel_number[place] = record + 1u;
    source[record] = from + 1u;
}
