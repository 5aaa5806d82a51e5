#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the faces that light can leave, for each of the six sides, and takes the light off those that stay dark. What the
// same faces of the same voxels had gathered before they keep.
#include "passes/inject/enclosed_faces.glsl"

layout(local_size_y = voxel_faces) in;
layout(set = 0, binding = 19, std430) writeonly buffer Exitance { vec4 exitance[]; };
layout(set = 0, binding = 20, std430) readonly buffer Kept { vec4 kept[]; };
layout(set = 0, binding = 21, std430) readonly buffer Sources { uint source[]; };  // find_kept.comp
layout(set = 0, binding = 22, std430) writeonly buffer Gathered { vec4 gathered[]; };
layout(set = 0, binding = 28, std430) writeonly buffer Lobes { uvec4 face_lobes[]; };
layout(constant_id = 22) const bool has_lobes = false;
layout(set = 0, binding = 25, std430) buffer LitFaces { LitFacesHeader header; uint lit_records[]; };

layout(push_constant) uniform Push { InjectConstants push; };

shared uint listed[voxel_faces];  // by this workgroup
shared uint list_first[voxel_faces];
shared bool last_to_list;

bool vanishes(uint first) { return (records[first] | records[first + 1u] | records[first + 2u]) == 0u; }

bool reflects(uint record, uint face) {
    const uint index = record * voxel_faces + face;
    const uint first = index * voxel_field_count;
    const bool there = records[first + voxel_field_area] != 0u;
    const bool lit = there && !vanishes(first + voxel_field_albedo) && !vanishes(first + voxel_field_normal);
    if (there && !lit) {  // of the others nothing reads it
        exitance[index] = vec4(0.0f);
        if (has_lobes) face_lobes[index] = uvec4(0u);
    }
    const uint from = lit ? source[record] : 0u;
    gathered[index] = from != 0u ? kept[(from - 1u) * voxel_faces + face] : vec4(0.0f);
    return lit;
}

void write_arguments(uint face) {
    const uint count = atomicOr(header.groups[face].w, 0u);  // as other workgroups left it
    header.groups[face].xyz = spread_groups((count + 63u) / 64u).xyz;
    header.gather_groups[face] = spread_groups((count + gather_faces_a_group - 1u) / gather_faces_a_group);
}

void main() {
    const uint record = linear_invocation();
    const uint face = gl_LocalInvocationID.y;
    if (gl_LocalInvocationID.x == 0u) listed[face] = 0u;
    barrier();
    uint place = 0u;
    const bool lit = record < voxel_header.record_count && reflects(record, face);
    if (lit) place = atomicAdd(listed[face], 1u);
    barrier();
    if (gl_LocalInvocationID.x == 0u && listed[face] > 0u) list_first[face] = atomicAdd(header.groups[face].w, listed[face]);
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        last_to_list = record < voxel_header.record_count &&
                       atomicAdd(header.workgroups_done.x, 1u) == (voxel_header.record_count - 1u) / 64u;
    if (lit) {
        const bool enclosed = is_enclosed(ivec3(record_voxel(record, push.grid.size)), face, int(push.grid.size));
        lit_records[face * voxel_header.record_count + list_first[face] + place] = record | (enclosed ? lit_record_enclosed : 0u);
    }
    barrier();
    if (last_to_list && gl_LocalInvocationID.x == 0u) write_arguments(face);
}
