#version 460
#extension GL_GOOGLE_include_directive : require
// Occupancy of the voxels of one cascade.
#include "passes/inject/record_work.glsl"
#include "passes/occupancy/occupancy.glsl"

layout(push_constant) uniform Push { InjectConstants push; };

void main() {
    const uint record = linear_invocation();
    if (record >= voxel_header.record_count) return;
    const ivec3 voxel = ivec3(record_voxel(record, push.grid.size));
    mark_occupied(voxel, occupied_faces(voxel, push.grid.size, push.cascade), push.grid.size, occupancy_first(push.grid.size, push.cascade, 0u));
}
