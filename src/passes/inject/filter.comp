#version 460
#extension GL_GOOGLE_include_directive : require
// One coarser level. Of two voxels behind each other the front one covers the rear one, pieces of one surface side by
// side (docs/gi-theory.md), and four such pairs side by side are averaged. What shows its front hides rears.
#include "passes/inject/isotropic.glsl"
#include "passes/inject/level_work.glsl"

layout(local_size_y = 6) in;  // a side each
layout(set = 0, binding = 20, rgba16f) uniform readonly image3D fine;
layout(set = 0, binding = 21, rgba16f) uniform writeonly image3D coarse;
layout(set = 0, binding = 22, r16f) uniform readonly image3D fine_depths;
layout(set = 0, binding = 23, r16f) uniform writeonly image3D coarse_depths;
layout(constant_id = 0) const bool isotropic = false;

/// Two voxels behind each other: cover and depth × cover. Returns how much of the rear one is seen.
float add_column(vec2 front, vec2 rear, bool front_is_upper, inout vec2 sum) {
    const float seen = seen_behind(front.x, rear.x);
    const vec2 upper = front_is_upper ? front : rear * seen;
    sum += vec2(front.x + rear.x * seen, 0.5f * (front.y + rear.y * seen + upper.x));  // the upper half of the coarse one's depth
    return seen;
}
/// Cover and depth × cover of what is seen from the front, or (`sign` = −1) from behind.
vec2 seen_from(float sign, float cover, float depth) { return sign * cover > 0.0f ? sign * vec2(cover, depth) : vec2(0.0f); }

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
    vec3 radiance = vec3(0.0f);
    vec2 shown = vec2(0.0f);
    vec2 behind = vec2(0.0f);
    for (int i = 0; i < 4; ++i) {
        const ivec3 base = first + (i & 1) * across_u + (i >> 1) * across_v;
        const ivec3 rear = base + along - front;
        const vec4 front_face = imageLoad(fine, base + front);
        const vec4 rear_face = imageLoad(fine, rear);
        const float front_depth = imageLoad(fine_depths, base + front).r;
        const float rear_depth = imageLoad(fine_depths, rear).r;
        radiance += front_face.rgb + rear_face.rgb * add_column(seen_from(1.0f, front_face.a, front_depth),
                                                                seen_from(1.0f, rear_face.a, rear_depth), side == 0, shown);
        add_column(seen_from(-1.0f, front_face.a, front_depth), seen_from(-1.0f, rear_face.a, rear_depth), side == 0, behind);
    }
    const vec2 result = 0.25f * (shown.x > 0.0f ? shown : -behind);
    depth_out = result.y;
    return vec4(0.25f * radiance, result.x);
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
        const vec4 shown = front * float(front.a > 0.0f) + rear * float(rear.a > 0.0f);
        sum += shown;
        if (shown.a > 0.0f) depth[axis] = (positive + negative) / shown.a;
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
