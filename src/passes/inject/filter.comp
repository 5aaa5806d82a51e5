#version 460
#extension GL_GOOGLE_include_directive : require
// One coarser level. Of two voxels behind each other the front one covers the rear one, pieces of one surface side by
// side (docs/gi-theory.md), and four such pairs side by side are averaged.
#include "passes/inject/isotropic.glsl"
#include "passes/inject/level_work.glsl"

layout(local_size_y = 6) in;  // a side each
layout(set = 0, binding = 20, rgba16f) uniform readonly image3D fine;
layout(set = 0, binding = 21, rgba16f) uniform writeonly image3D coarse;
layout(set = 0, binding = 22, r16f) uniform readonly image3D fine_depths;
layout(set = 0, binding = 23, r16f) uniform writeonly image3D coarse_depths;
layout(constant_id = 0) const bool isotropic = false;

/// What the coarse texel of one side shows; `depth_out`: depth × cover.
vec4 filtered(ivec3 texel, int axis, int side, out float depth_out) {
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
    depth_out = 0.25f * depth;
    return 0.25f * sum;
}

void write(ivec3 texel, vec4 value, float depth) {
    imageStore(coarse, texel, value);
    imageStore(coarse_depths, texel, vec4(depth));
}

/// One value for all sides, as the finest voxels have it.
void write_isotropic(ivec3 voxel, int size) {
    float cover = 0.0f;
    vec4 sum = vec4(0.0f);
    vec3 depth = vec3(0.0f);  // mean along each axis
    for (int axis = 0; axis < 3; ++axis) {
        float positive;
        float negative;
        const vec4 front = filtered(face_corner(axis, 0, size) + voxel, axis, 0, positive);
        const vec4 rear = filtered(face_corner(axis, 1, size) + voxel, axis, 1, negative);
        cover = max(cover, max(front.a, rear.a));
        sum += front + rear;
        if (front.a + rear.a > 0.0f) depth[axis] = (positive + negative) / (front.a + rear.a);
    }
    const vec4 value = isotropic_value(sum, cover);
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) write(face_corner(axis, side, size) + voxel, value, depth[axis] * cover);
}

void main() {
    ivec3 voxel;
    int size;
    if (!level_voxel(voxel, size)) return;
    const int face = int(gl_LocalInvocationID.y);
    if (isotropic) {
        if (face == 0) write_isotropic(voxel, size);
        return;
    }
    const ivec3 texel = face_corner(face >> 1, face & 1, size) + voxel;
    float depth;
    const vec4 value = filtered(texel, face >> 1, face & 1, depth);
    write(texel, value, depth);
}
