#version 460
#extension GL_GOOGLE_include_directive : require
// Evaluates the surfaces of all instances that are voxelized, once each.
#include "passes/voxelize/linear_groups.glsl"
#include "passes/voxelize/voxel_ranges.glsl"
#include "passes/voxelize/voxel_surface.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 13, std430) writeonly buffer Surfaces { VoxelSurface even_surfaces[]; };

void main() {
    const uint range = linear_invocation();
    if (range >= push.range_count || ranges[range].instance >= most_even_surfaces) return;
    const InstanceData instance = instance_table[ranges[range].instance];
    even_surfaces[ranges[range].instance] = even_surface(geometry_table[instance.geometry], material_table[instance.material]);
}
