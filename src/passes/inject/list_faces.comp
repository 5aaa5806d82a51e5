#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the faces that light can leave, for each of the six sides, and takes the light off those that stay dark.
#include "passes/inject/record_work.glsl"

layout(set = 0, binding = 19, std430) writeonly buffer Illuminance { vec4 illuminance[]; };
layout(set = 0, binding = 22, std430) writeonly buffer Gathered { vec4 gathered[]; };
layout(set = 0, binding = 25, std430) buffer LitFaces { LitFacesHeader header; uint lit_records[]; };

shared uint listed[voxel_faces];  // by this workgroup
shared uint list_first[voxel_faces];

bool vanishes(uint first) { return (records[first] | records[first + 1u] | records[first + 2u]) == 0u; }

bool reflects(uint index) {
    const uint first = index * voxel_field_count;
    if (records[first + voxel_field_area] == 0u) return false;  // nothing reads its light
    if (!vanishes(first + voxel_field_albedo) && !vanishes(first + voxel_field_normal)) return true;
    illuminance[index] = vec4(0.0f);
    gathered[index] = vec4(0.0f);
    return false;
}

/// Makes room for `count` more entries, and for the workgroups that they need.
uint append(uint face, uint count) {
    const uint first = atomicAdd(header.groups[face].w, count);
    const uvec4 groups = spread_groups((first + count + 63u) / 64u);
    const uvec4 gather = spread_groups((first + count + gather_faces_a_group - 1u) / gather_faces_a_group);
    atomicMax(header.groups[face].x, groups.x);
    atomicMax(header.groups[face].y, groups.y);
    atomicMax(header.gather_groups[face].x, gather.x);
    atomicMax(header.gather_groups[face].y, gather.y);
    header.groups[face].z = 1u;
    header.gather_groups[face].z = 1u;
    return first;
}

void main() {
    const uint record = linear_invocation();
    const uint own_face = gl_LocalInvocationID.x;
    if (own_face < voxel_faces) listed[own_face] = 0u;
    barrier();
    uint place[voxel_faces];
    uint lit = 0u;
    for (uint face = 0u; face < voxel_faces; ++face) {
        if (record >= voxel_header.record_count || !reflects(record * voxel_faces + face)) continue;
        place[face] = atomicAdd(listed[face], 1u);
        lit |= 1u << face;
    }
    barrier();
    if (own_face < voxel_faces && listed[own_face] > 0u) list_first[own_face] = append(own_face, listed[own_face]);
    barrier();
    for (uint face = 0u; face < voxel_faces; ++face)
        if ((lit & (1u << face)) != 0u) lit_records[face * voxel_header.record_count + list_first[face] + place[face]] = record;
}
