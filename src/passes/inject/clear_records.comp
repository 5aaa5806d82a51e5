#version 460
#extension GL_GOOGLE_include_directive : require
// Empties the occupied voxels of a cascade, before its surfaces are voxelized anew.
#include "passes/inject/record_work.glsl"

layout(local_size_y = voxel_faces) in;  // a side each
layout(set = 0, binding = 20, rgba16f) uniform writeonly image3D faces;
layout(set = 0, binding = 21, r16f) uniform writeonly image3D depths;
layout(push_constant) uniform Push { InjectConstants push; };

void main() {
    const uint record = linear_invocation();
    if (record >= voxel_header.record_count) return;
    const ivec3 texel = face_texel(record_voxel(record, push.grid.size), gl_LocalInvocationID.y, push.grid.size, push.cascade);
    imageStore(faces, texel, vec4(0.0f));
    imageStore(depths, texel, vec4(0.0f));
}
