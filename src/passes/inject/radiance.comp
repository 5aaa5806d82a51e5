#version 460
#extension GL_GOOGLE_include_directive : require
// Writes what the faces of every occupied voxel show: radiance × cover, and the share of the voxel's face they cover,
// and how deep in the voxel they stand.
#include "passes/inject/record_work.glsl"
#include "shading/sampling.h"

layout(set = 0, binding = 19, std430) readonly buffer Illuminance { vec4 illuminance[]; };  // of the lights
layout(set = 0, binding = 20, rgba16f) uniform writeonly image3D faces;
layout(set = 0, binding = 21, r16f) uniform writeonly image3D depths;
layout(set = 0, binding = 22, std430) readonly buffer Gathered { vec4 gathered[]; };
layout(constant_id = 0) const bool emission_only = false;
layout(push_constant) uniform Push { InjectConstants push; };

const float largest_half = 65504.0f;

void write_face(uint record, uint face_index, ivec3 texel) {
    const VoxelFace face = voxel_face(push.grid, record, face_index);
    if (face.area <= 0.0f) {
        imageStore(faces, texel, vec4(0.0f));
        imageStore(depths, texel, vec4(0.0f));
        return;
    }
    const float cover = min(face.area, 1.0f);
    vec3 radiance = face.emission * push.grid.emission_unit;
    if (!emission_only) {
        const uint index = record * voxel_faces + face_index;
        radiance += cover * face.albedo * inverse_pi * (illuminance[index].rgb + gathered[index].rgb);
    }
    imageStore(faces, texel, vec4(min(radiance / push.grid.radiance_unit, vec3(largest_half)), cover));
    imageStore(depths, texel, vec4(cover * clamp(face.within[face_index >> 1u], 0.0f, 1.0f)));
}

void main() {
    const uint record = linear_invocation();
    if (record >= voxel_header.record_count) return;
    const uvec3 voxel = record_voxel(record, push.grid.size);
    for (uint face = 0u; face < voxel_faces; ++face)
        write_face(record, face, face_texel(voxel, face, push.grid.size, push.cascade));
}
