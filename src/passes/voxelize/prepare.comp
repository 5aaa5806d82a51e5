#version 460
#extension GL_GOOGLE_include_directive : require
// Clears the records or fills those that are carried from others, and lists on every coarser level the voxels that
// hold anything.
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, std430) readonly buffer Numbers { VoxelHeader header; };
layout(set = 0, binding = 17, std430) readonly buffer Cells { uint record_cell[]; };
layout(set = 0, binding = 18, std430) writeonly buffer Records { uint records[]; };
layout(set = 0, binding = 20, std430) buffer Levels { VoxelLevelsHeader levels; uint level_voxel[]; };
layout(set = 0, binding = 21, std430) buffer Listed { uint listed[]; };  // a bit a coarse voxel, level after level
layout(set = 0, binding = 22, std430) readonly buffer Sources { uint source[]; };  // by record: 0, or 1 + the carried one
layout(set = 0, binding = 23, std430) readonly buffer Carried { uint carried_records[]; };
layout(constant_id = 0) const bool carries = false;
layout(push_constant) uniform Push { VoxelizeConstants push; };

void append(uint level, uint voxel) {
    const uint place = atomicAdd(levels.groups[level].w, 1u);
    level_voxel[voxel_level_first(level, push.grid.size, push.record_capacity) + place] = voxel;
    if (place % 64u != 0u) return;
    const uvec4 groups = spread_groups(place / 64u + 1u);
    atomicMax(levels.groups[level].x, groups.x);
    atomicMax(levels.groups[level].y, groups.y);
    levels.groups[level].z = 1u;
}

void main() {
    const uint invocation = linear_invocation();
    if (invocation >= header.record_count * voxel_faces) return;
    const uint from = carries ? source[invocation / voxel_faces] : 0u;
    const uint first = ((from - 1u) * voxel_faces + invocation % voxel_faces) * voxel_field_count;
    for (uint i = 0u; i < voxel_field_count; ++i)
        records[invocation * voxel_field_count + i] = from != 0u ? carried_records[first + i] : 0u;
    if (invocation % voxel_faces != 0u) return;
    const uint cell = record_cell[invocation / voxel_faces];
    uvec3 voxel = uvec3(cell % push.grid.size, cell / push.grid.size % push.grid.size, cell / (push.grid.size * push.grid.size));
    uint first_word = 0u;
    uint level = 1u;
    for (uint size = push.grid.size / 2u; size >= 1u; size /= 2u) {
        voxel /= 2u;
        const uint place = voxel.x + size * (voxel.y + size * voxel.z);
        const uint bit = 1u << (place % 32u);
        // Whoever comes first lists the levels above, too.
        if ((atomicOr(listed[first_word + place / 32u], bit) & bit) != 0u) return;
        append(level++, place);
        first_word += voxel_bit_words(size);
    }
}
