#version 460
#extension GL_GOOGLE_include_directive : require
// Lists on every coarser level the voxels that hold anything.
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, std430) readonly buffer Numbers { VoxelHeader header; };
layout(set = 0, binding = 17, std430) readonly buffer Cells { uint record_cell[]; };
layout(set = 0, binding = 20, std430) buffer Levels { VoxelLevelsHeader levels; uint level_voxel[]; };
layout(set = 0, binding = 21, std430) buffer Listed { uint listed[]; };  // a bit a coarse voxel, level after level
layout(push_constant) uniform Push { VoxelizeConstants push; };

shared uint new_count;
shared uint first_place;

/// Counts `count` more voxels of a level; returns the first's place in its list.
uint lengthen(uint level, uint count) {
    const uint place = atomicAdd(levels.groups[level].w, count);
    if ((place + 63u) / 64u == (place + count + 63u) / 64u) return place;
    const uvec4 groups = spread_groups((place + count + 63u) / 64u);
    atomicMax(levels.groups[level].x, groups.x);
    atomicMax(levels.groups[level].y, groups.y);
    levels.groups[level].z = 1u;
    return place;
}

void main() {
    const uint own = gl_LocalInvocationID.x;
    const uint record = linear_invocation();
    bool climbs = record < header.record_count;
    const uint cell = climbs ? record_cell[record] : 0u;
    uvec3 voxel = uvec3(cell % push.grid.size, cell / push.grid.size % push.grid.size, cell / (push.grid.size * push.grid.size));
    uint first_word = 0u;
    uint level = 1u;
    for (uint size = push.grid.size / 2u; size >= 1u; size /= 2u) {
        voxel /= 2u;
        const uint place = voxel.x + size * (voxel.y + size * voxel.z);
        const uint bit = 1u << (place % 32u);
        // Whoever comes first lists the levels above, too.
        climbs = climbs && (atomicOr(listed[first_word + place / 32u], bit) & bit) == 0u;
        if (own == 0u) new_count = 0u;
        barrier();
        const uint rank = climbs ? atomicAdd(new_count, 1u) : 0u;
        barrier();
        if (new_count == 0u) return;
        if (own == 0u) first_place = lengthen(level, new_count);
        barrier();
        if (climbs) level_voxel[voxel_level_first(level, push.grid.size, push.record_capacity) + first_place + rank] = place;
        first_word += voxel_bit_words(size);
        ++level;
    }
}
