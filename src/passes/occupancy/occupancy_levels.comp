#version 460
#extension GL_GOOGLE_include_directive : require
// Occupancy of one filtered level of the widest cascade.
#include "passes/inject/level_work.glsl"
#include "passes/occupancy/occupancy.glsl"

void main() {
    ivec3 voxel;
    int size;
    if (!level_voxel(voxel, size)) return;
    mark_occupied(voxel, occupied_faces(voxel, uint(size), push.cascade), uint(size), occupancy_first(push.size, push.cascade, push.level));
}
