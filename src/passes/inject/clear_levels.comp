#version 460
#extension GL_GOOGLE_include_directive : require
// Empties the occupied voxels of one coarse level.
#include "passes/inject/level_work.glsl"

layout(set = 0, binding = 20, rgba16f) uniform writeonly image3D faces;
layout(set = 0, binding = 21, r16f) uniform writeonly image3D depths;

void main() {
    ivec3 voxel;
    int size;
    if (!level_voxel(voxel, size)) return;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            imageStore(faces, face_corner(axis, side, size) + voxel, vec4(0.0f));
            imageStore(depths, face_corner(axis, side, size) + voxel, vec4(0.0f));
        }
}
