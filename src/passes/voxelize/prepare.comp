#version 460
#extension GL_GOOGLE_include_directive : require
// Clears the records or fills those that are carried from others. A workgroup takes 64 records.
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, std430) readonly buffer Numbers { VoxelHeader header; };
layout(set = 0, binding = 18, std430) writeonly buffer Records { uvec2 records[]; };
layout(set = 0, binding = 22, std430) readonly buffer Sources { uint source[]; };  // by record: 0, or 1 + the carried one
layout(set = 0, binding = 23, std430) readonly buffer Carried { uvec2 carried_records[]; };
layout(constant_id = 0) const bool carries = false;
layout(push_constant) uniform Push { VoxelizeConstants push; };

const uint pairs = voxel_faces * voxel_field_count / 2u;  // of words in a record

void main() {
    const uint first = linear_group() * 64u * pairs;
    for (uint i = first + gl_LocalInvocationID.x; i < min(first + 64u * pairs, header.record_count * pairs); i += 64u) {
        const uint from = carries ? source[i / pairs] : 0u;
        records[i] = from != 0u ? carried_records[(from - 1u) * pairs + i % pairs] : uvec2(0u);
    }
}
