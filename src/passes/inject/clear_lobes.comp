#version 460
#extension GL_GOOGLE_include_directive : require
// Empties the occupied voxels of one coarse level of what faces send ahead.
#include "passes/inject/level_work.glsl"

layout(local_size_y = 6) in;  // a side each
layout(set = 0, binding = 20, rgba16f) uniform writeonly image3D lobes;

void main() {
    ivec3 voxel;
    int size;
    if (!level_voxel(voxel, size)) return;
    const int face = int(gl_LocalInvocationID.y);
    const ivec3 texel = face_corner(face >> 1, face & 1, size) + voxel;
    imageStore(lobes, texel, vec4(0.0f));
    imageStore(lobes, texel + ivec3(0, 0, 3 * size), vec4(0.0f));
}
