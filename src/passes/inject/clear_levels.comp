#version 460
#extension GL_GOOGLE_include_directive : require
// Empties the occupied voxels of one coarse level.
#include "passes/inject/level_work.glsl"

layout(local_size_y = 6) in;  // a side each
layout(set = 0, binding = 20, rgba16f) uniform writeonly image3D faces;
layout(set = 0, binding = 21, r16f) uniform writeonly image3D depths;

void main() {
    ivec3 voxel;
    int size;
    if (!level_voxel(voxel, size)) return;
    const int face = int(gl_LocalInvocationID.y);
    const ivec3 texel = face_corner(face >> 1, face & 1, size) + voxel;
    imageStore(faces, texel, vec4(0.0f));
    imageStore(depths, texel, vec4(0.0f));
}
