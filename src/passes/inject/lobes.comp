#version 460
#extension GL_GOOGLE_include_directive : require
// One level of what faces send ahead, from level 1 on: of two voxels behind each other the front one covers the rear one
// as in filter.comp, and four such pairs side by side are averaged.
#include "passes/inject/face_lobe.glsl"
#include "passes/inject/level_work.glsl"

layout(local_size_y = voxel_faces) in;  // a side each
layout(set = 0, binding = 18, std430) readonly buffer Records { uint records[]; };
layout(set = 0, binding = 19, std430) readonly buffer Numbers { VoxelHeader voxel_header; uint voxel_number[]; };
layout(set = 0, binding = 20, rgba16f) uniform readonly image3D fine;
layout(set = 0, binding = 21, rgba16f) uniform writeonly image3D coarse;
layout(set = 0, binding = 28, std430) readonly buffer Lobes { uvec4 face_lobes[]; };
layout(constant_id = 0) const bool emission_only = false;
layout(constant_id = 1) const bool from_records = false;

/// As the texture has it, times cover: the light with the cover itself, the direction with its weight.
struct ShownLobe {
    vec4 light;
    vec4 direction;
};

/// Of a voxel of the finest level.
ShownLobe recorded(ivec3 voxel, uint face, int size) {
    ShownLobe shown = ShownLobe(vec4(0.0f), vec4(0.0f));
    const uint number = voxel_number[voxel.x + size * (voxel.y + size * voxel.z)];
    if (number == 0u || number == voxel_without_room) return shown;
    const uint index = (number - 1u) * voxel_faces + face;
    const float cover = min(float(records[index * voxel_field_count + voxel_field_area]) / voxel_fixed_one, 1.0f);
    if (cover == 0.0f) return shown;
    const FaceLobe lobe = unpacked_lobe(emission_only ? uvec4(0u) : face_lobes[index]);
    return ShownLobe(cover * vec4(lobe.light, 1.0f), cover * vec4(lobe.direction, lobe.weight));
}

ShownLobe shown_by(ivec3 voxel, uint face, int size) {
    if (from_records) return recorded(voxel, face, size);
    const ivec3 texel = face_corner(int(face >> 1u), int(face & 1u), size) + voxel;
    return ShownLobe(imageLoad(fine, texel), imageLoad(fine, texel + ivec3(0, 0, 3 * size)));
}

void main() {
    ivec3 voxel;
    int size;
    if (!level_voxel(voxel, size)) return;
    const uint face = gl_LocalInvocationID.y;
    const int axis = int(face >> 1u);
    ivec3 along = ivec3(0);
    ivec3 across_u = ivec3(0);
    ivec3 across_v = ivec3(0);
    along[axis] = 1;
    across_u[(axis + 1) % 3] = 1;
    across_v[(axis + 2) % 3] = 1;
    const ivec3 front = (face & 1u) == 0u ? along : ivec3(0);
    ShownLobe sum = ShownLobe(vec4(0.0f), vec4(0.0f));
    for (int i = 0; i < 4; ++i) {
        const ivec3 base = 2 * voxel + (i & 1) * across_u + (i >> 1) * across_v;
        const ShownLobe before = shown_by(base + front, face, 2 * size);
        const ShownLobe behind = shown_by(base + along - front, face, 2 * size);
        const float seen = seen_behind(before.light.a, behind.light.a);
        sum.light += before.light + seen * behind.light;
        sum.direction += before.direction + seen * behind.direction;
    }
    const ivec3 texel = face_corner(axis, int(face & 1u), size) + voxel;
    imageStore(coarse, texel, 0.25f * sum.light);
    imageStore(coarse, texel + ivec3(0, 0, 3 * size), 0.25f * sum.direction);
}
