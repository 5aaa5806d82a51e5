#version 460
#extension GL_GOOGLE_include_directive : require
// One coarser level. Of two voxels behind each other the front one covers the rear one, pieces of one surface side by
// side (docs/gi-theory.md), and four such pairs side by side are averaged.
#include "passes/inject/level_work.glsl"

layout(set = 0, binding = 20, rgba16f) uniform readonly image3D fine;
layout(set = 0, binding = 21, rgba16f) uniform writeonly image3D coarse;

vec4 behind(vec4 front, vec4 rear) {
    return rear.a > 0.0f ? front + rear * (min(1.0f - front.a, rear.a) / rear.a) : front;
}

vec4 filtered(ivec3 first, int axis, int side) {
    ivec3 along = ivec3(0);
    ivec3 across_u = ivec3(0);
    ivec3 across_v = ivec3(0);
    along[axis] = 1;
    across_u[(axis + 1) % 3] = 1;
    across_v[(axis + 2) % 3] = 1;
    const ivec3 front = side == 0 ? along : ivec3(0);
    vec4 sum = vec4(0.0f);
    for (int i = 0; i < 4; ++i) {
        const ivec3 base = first + (i & 1) * across_u + (i >> 1) * across_v;
        sum += behind(imageLoad(fine, base + front), imageLoad(fine, base + along - front));
    }
    return sum * 0.25f;
}

void main() {
    ivec3 voxel;
    int size;
    if (!level_voxel(voxel, size)) return;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            imageStore(coarse, face_corner(axis, side, size) + voxel, filtered(2 * (face_corner(axis, side, size) + voxel), axis, side));
}
