#version 460
#extension GL_GOOGLE_include_directive : require
// One coarser level. Of two voxels behind each other the front one covers the rear one, pieces of one surface side by
// side (docs/gi-theory.md), and four such pairs side by side are averaged.
#include "passes/inject/level_work.glsl"

layout(set = 0, binding = 20, rgba16f) uniform readonly image3D fine;
layout(set = 0, binding = 21, rgba16f) uniform writeonly image3D coarse;
layout(set = 0, binding = 22, r16f) uniform readonly image3D fine_depths;
layout(set = 0, binding = 23, r16f) uniform writeonly image3D coarse_depths;

void write_filtered(ivec3 texel, int axis, int side) {
    const ivec3 first = 2 * texel;
    ivec3 along = ivec3(0);
    ivec3 across_u = ivec3(0);
    ivec3 across_v = ivec3(0);
    along[axis] = 1;
    across_u[(axis + 1) % 3] = 1;
    across_v[(axis + 2) % 3] = 1;
    const ivec3 front = side == 0 ? along : ivec3(0);
    vec4 sum = vec4(0.0f);
    float depth = 0.0f;
    for (int i = 0; i < 4; ++i) {
        const ivec3 base = first + (i & 1) * across_u + (i >> 1) * across_v;
        const ivec3 rear = base + along - front;
        const vec4 front_face = imageLoad(fine, base + front);
        const vec4 rear_face = imageLoad(fine, rear);
        const float seen = rear_face.a > 0.0f ? min(1.0f - front_face.a, rear_face.a) / rear_face.a : 0.0f;
        sum += front_face + rear_face * seen;
        // Of the two voxels the one on the positive side takes the upper half of the coarse one's depth.
        const float front_depth = imageLoad(fine_depths, base + front).r + (side == 0 ? front_face.a : 0.0f);
        const float rear_depth = imageLoad(fine_depths, rear).r + (side == 0 ? 0.0f : rear_face.a);
        depth += 0.5f * (front_depth + seen * rear_depth);
    }
    imageStore(coarse, texel, 0.25f * sum);
    imageStore(coarse_depths, texel, vec4(0.25f * depth));
}

void main() {
    ivec3 voxel;
    int size;
    if (!level_voxel(voxel, size)) return;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) write_filtered(face_corner(axis, side, size) + voxel, axis, side);
}
