// Reads back what voxelization summed. Invocations beyond VoxelHeader.record_count have no record.
#ifndef HELIODON_VOXEL_RECORD_GLSL
#define HELIODON_VOXEL_RECORD_GLSL
#include "passes/voxelize/voxel_shared.h"

layout(set = 0, binding = 17, std430) readonly buffer Cells { uint record_cell[]; };
layout(set = 0, binding = 18, std430) readonly buffer Records { uint records[]; };

/// What one face of a voxel shows; nothing but zeros where the area is 0, but for what it sees from behind.
struct VoxelFace {
    float area;      // shown, in faces of a voxel
    float behind;    // of what it sees from behind, likewise
    vec3 albedo;     // mean over the area
    float specular;  // of it, mean of the channels
    float alpha;     // of what is specular
    vec3 emission;   // radiance × cover in units of the grid's emission: 1 face of emitters at most
    vec3 normal;     // unit
    float straight;  // length of the normals' mean
    vec3 position;   // world, on the surface's outer side
    vec3 within;     // the centroid in the voxel, 0 … 1; its middle for what is seen from behind
};

uvec3 record_voxel(uint record, uint size) {
    const uint cell = record_cell[record];
    return uvec3(cell % size, cell / size % size, cell / (size * size));
}

vec3 record_vector(uint first) {
    return vec3(uvec3(records[first], records[first + 1u], records[first + 2u])) * (1.0f / voxel_fixed_one);
}

VoxelFace voxel_face(VoxelGrid grid, uint record, uint face) {
    const uint first = (record * voxel_faces + face) * voxel_field_count;
    VoxelFace result = VoxelFace(0.0f, 0.0f, vec3(0.0f), 0.0f, 0.0f, vec3(0.0f), vec3(0.0f), 0.0f, vec3(0.0f), vec3(0.0f));
    result.behind = float(records[first + voxel_field_behind]) * (1.0f / voxel_fixed_one);
    result.within = vec3(0.5f);
    if (records[first] == 0u) return result;
    result.area = float(records[first]) * (1.0f / voxel_fixed_one);
    const float inverse = 1.0f / result.area;
    result.albedo = record_vector(first + voxel_field_albedo) * inverse;
    result.specular = float(records[first + voxel_field_specular]) * (inverse / voxel_fixed_one);
    result.alpha = float(records[first + voxel_field_alpha]) / float(max(records[first + voxel_field_specular], 1u));
    // Where more surface lies in the voxel than it has room for, what emits is not thinned by what does not.
    const float emissive = float(records[first + voxel_field_emissive_area]) * (1.0f / voxel_fixed_one);
    result.emission = record_vector(first + voxel_field_emission) / max(1.0f, emissive);
    const uint n = first + voxel_field_normal;
    const vec3 sum = vec3(ivec3(int(records[n]), int(records[n + 1u]), int(records[n + 2u]))) * (inverse / voxel_fixed_one);
    result.straight = min(length(sum), 1.0f);
    result.normal = result.straight > 0.0f ? normalize(sum) : vec3(0.0f);
    // The centroid of a curved piece lies under its surface by no more than the sagitta of a chord as long as
    // the voxel's diagonal, and the fixed point places it with a finite step: step over both.
    const float under = 0.5f * sqrt(3.0f) * (sqrt(max(0.0f, 1.0f - result.straight * result.straight)) + 4.0f / float(records[first]));
    result.within = record_vector(first + voxel_field_position) * inverse;
    result.position = grid.origin + grid.voxel_m * (vec3(ivec3(record_voxel(record, grid.size)) + grid.base) + result.within + result.normal * under);
    return result;
}

#endif
