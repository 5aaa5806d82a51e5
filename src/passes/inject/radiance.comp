#version 460
#extension GL_GOOGLE_include_directive : require
// Writes what the faces of every occupied voxel show: radiance × cover, and the share of the voxel's face they cover,
// and how deep in the voxel they stand.
#include "passes/inject/isotropic.glsl"
#include "passes/inject/record_work.glsl"
#include "shading/sampling.h"

layout(local_size_y = voxel_faces) in;  // a side each: of one voxel they stand side by side in memory
layout(set = 0, binding = 19, std430) readonly buffer Exitance { vec4 exitance[]; };  // reflected of the lights
layout(set = 0, binding = 20, rgba16f) uniform writeonly image3D faces;
layout(set = 0, binding = 21, r16f) uniform writeonly image3D depths;
layout(set = 0, binding = 22, std430) readonly buffer Gathered { vec4 gathered[]; };
layout(constant_id = 0) const bool emission_only = false;
layout(constant_id = 1) const bool isotropic = false;
layout(push_constant) uniform Push { InjectConstants push; };

const float largest_half = 65504.0f;

/// Radiance × cover in units of the grid's, and cover: negative where it sees surfaces from behind alone.
vec4 face_value(VoxelFace face, uint index) {
    if (face.area <= 0.0f) return vec4(vec3(0.0f), -min(face.behind, 1.0f));
    const float cover = min(face.area, 1.0f);
    vec3 radiance = face.emission * push.grid.emission_unit;
    if (!emission_only) radiance += cover * inverse_pi * (exitance[index].rgb + face.albedo * gathered[index].rgb);
    return vec4(radiance / push.grid.radiance_unit, cover);
}

void write_face(ivec3 texel, vec4 value, float within) {
    imageStore(faces, texel, vec4(min(value.rgb, vec3(largest_half)), value.a));
    imageStore(depths, texel, vec4(value.a * clamp(within, 0.0f, 1.0f)));
}

/// One value and one place for all sides. What stands in a voxel shows some side its front, so that rears have no part.
void write_isotropic(uint record, uvec3 voxel) {
    float cover = 0.0f;
    vec4 shining = vec4(0.0f);
    vec4 place = vec4(0.0f);
    for (uint i = 0u; i < voxel_faces; ++i) {
        const VoxelFace face = voxel_face(push.grid, record, i);
        if (face.area <= 0.0f) continue;
        const vec4 value = face_value(face, record * voxel_faces + i);
        cover = max(cover, value.a);
        place += value.a * vec4(face.within, 1.0f);
        shining += value;
    }
    const vec4 value = isotropic_value(shining, cover);
    const vec3 within = place.a > 0.0f ? place.xyz / place.a : vec3(0.0f);
    for (uint i = 0u; i < voxel_faces; ++i)
        write_face(face_texel(voxel, i, push.grid.size, push.cascade), value, within[i >> 1u]);
}

void main() {
    const uint record = linear_invocation();
    if (record >= voxel_header.record_count) return;
    const uvec3 voxel = record_voxel(record, push.grid.size);
    const uint side = gl_LocalInvocationID.y;
    if (isotropic) {
        if (side == 0u) write_isotropic(record, voxel);
        return;
    }
    const VoxelFace face = voxel_face(push.grid, record, side);
    const vec4 value = face_value(face, record * voxel_faces + side);
    write_face(face_texel(voxel, side, push.grid.size, push.cascade), value, face.within[side >> 1u]);
}
