// Adds what a voxel holds of a triangle to the voxel's record. The includer defines, before this,
//   uint face_sums(uint face)  place of the first sum of a face, numbered through all records
//   void add_to_sum(uint place, uint amount)
#ifndef HELIODON_VOXEL_SUM_GLSL
#define HELIODON_VOXEL_SUM_GLSL
#include "passes/common/hash.glsl"
#include "passes/voxelize/clip.glsl"
#include "passes/voxelize/voxel_surface.glsl"

layout(set = 0, binding = 13, std430) readonly buffer Surfaces { VoxelSurface even_surfaces[]; };  // by instance

void add(uint place, float value, float rounding) {
    const int amount = int(floor(clamp(value, -2047.0f, 2047.0f) * voxel_fixed_one + rounding));
    if (amount != 0) add_to_sum(place, uint(amount));
}

/// One side's share of the record's face; a black one has no colour. Neighbouring invocations often add to the same face:
/// each begins with another of its fields, by `turn`, so that they do not wait for each other.
void add_to_face(uint face, VoxelSurface surface, bool black, vec3 normal, vec3 position, float area, uint turn, float rounding) {
    const float shown = area * surface.cover;
    const uint place = face_sums(face);
    add(place + voxel_field_area, shown, rounding);
    uint group = turn / 3u % 3u;
    for (uint i = 0u; i < 3u; ++i) {
        const vec3 sums = group == 0u ? area * surface.albedo : shown * (group == 1u ? normal : clamp(position, 0.0f, 1.0f));
        const uint field = group == 0u ? voxel_field_albedo : group == 1u ? voxel_field_normal : voxel_field_position;
        uint axis = turn % 3u;
        for (uint j = 0u; j < 3u && !(black && group == 0u); ++j) {
            add(place + field + axis, axis == 0u ? sums.x : axis == 1u ? sums.y : sums.z, rounding);
            axis = axis == 2u ? 0u : axis + 1u;
        }
        group = group == 2u ? 0u : group + 1u;
    }
    if (black || !any(greaterThan(surface.emission, vec3(0.0f)))) return;
    for (uint c = 0u; c < 3u; ++c) add(place + voxel_field_emission + c, area * surface.emission[c], rounding);
    add(place + voxel_field_emissive_area, area * surface.opacity, rounding);
}

/// `record`: the voxel's; `turn`: as in add_to_face().
void sum(VoxelTriangle triangle, ivec3 voxel, uint record, uint turn) {
    const vec4 part = centroid_and_area(triangle.p0, triangle.p1, triangle.p2, vec3(voxel));
    if (!(part.w > 0.0f)) return;
    VoxelSurface surface;
    surface.flags = voxel_surface_varies;
    if (triangle.instance < most_even_surfaces) surface = even_surfaces[triangle.instance];
    if ((surface.flags & voxel_surface_varies) != 0u) surface = surface_at(triangle, voxel, part.xyz);
    if (!(surface.opacity > 0.0f)) return;
    const bool two_sided = (surface.flags & voxel_surface_two_sided) != 0u;
    const bool closed = (surface.flags & voxel_surface_closed) != 0u;
    // Up or down at random, by what is rounded alone: pieces smaller than the fixed point's step count on average,
    // and every run gives the same sums.
    const uvec3 in_lattice = uvec3(voxel + push.grid.base);
    const uint of_triangle = pcg_hash(triangle.primitive + pcg_hash(triangle.instance));
    const float rounding = unit_interval(pcg_hash(in_lattice.x + pcg_hash(in_lattice.y + pcg_hash(in_lattice.z + of_triangle))));
    // The faces that see a side of it, a bit each: a loop over them alone keeps neighbouring invocations together.
    uint faces = 0u;
    for (uint axis = 0u; axis < 3u; ++axis) {
        const float along = triangle.normal[axis];
        if (along != 0.0f) faces |= (along > 0.0f ? 1u : 2u) << (2u * axis);
        if (along != 0.0f && (two_sided || !closed)) faces |= 3u << (2u * axis);
    }
    while (faces != 0u) {
        const uint face = uint(findLSB(faces));
        faces &= faces - 1u;
        const float along = triangle.normal[face >> 1u];
        const bool rear = (along > 0.0f) == ((face & 1u) != 0u);
        add_to_face(record * voxel_faces + face, surface, rear && !two_sided, rear ? -triangle.normal : triangle.normal, part.xyz,
                    part.w * abs(along), turn, rounding);
    }
}

#endif
