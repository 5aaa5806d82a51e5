#version 460
#extension GL_GOOGLE_include_directive : require
// What the numbering found so far, as arguments of dispatches.
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 16, std430) buffer Numbers { VoxelHeader header; };
layout(set = 0, binding = 20, std430) writeonly buffer TileArguments { uvec4 tile_arguments; };  // those of tiles alone, or with all triangles
layout(push_constant) uniform Push { VoxelizeConstants push; };

void main() {
    header.tile_count = min(header.tile_demand, push.tile_capacity);
    header.tile_groups = spread_groups(header.tile_count);
    tile_arguments = push.over_tiles != 0u ? header.tile_groups
                                           : spread_groups(header.tile_count + (push.triangle_count + 63u) / 64u);
    header.record_count = min(header.record_demand, push.record_capacity);
    header.record_groups = spread_groups((header.record_count + 63u) / 64u);
}
