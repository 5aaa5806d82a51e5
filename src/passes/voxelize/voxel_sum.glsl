// Adds what a voxel holds of a triangle to the voxel's record. The includer defines, before this,
//   VoxelSums  struct { uint first; uint stride; }: where a voxel's sums stand, and how many places a face takes
//   VoxelSums find_sums(uint record)
//   void add_to_sum(uint place, uint amount)
//   void add_to_record(uint word, uint amount)
#ifndef HELIODON_VOXEL_SUM_GLSL
#define HELIODON_VOXEL_SUM_GLSL
#include "passes/common/hash.glsl"
#include "passes/voxelize/clip.glsl"
#include "passes/voxelize/voxel_surface.glsl"

layout(set = 0, binding = 13, std430) readonly buffer Surfaces { VoxelSurface even_surfaces[]; };  // by instance

/// No piece shows a voxel's face more than three faces' area: nothing comes near the ends of an integer.
uint fixed_point(float value, float rounding) { return uint(int(floor(value * voxel_fixed_one + rounding))); }

void add(uint place, float value, float rounding) {
    const uint amount = fixed_point(value, rounding);
    if (amount != 0u) add_to_sum(place, amount);
}
void add(uint place, vec3 values, float rounding) {
    add(place, values.x, rounding);
    add(place + 1u, values.y, rounding);
    add(place + 2u, values.z, rounding);
}

/// What emits is seldom: its sums go to the record itself.
void add_emission(uint face, vec3 emission, float area, float rounding) {
    const uint first = face * voxel_field_count;
    for (uint c = 0u; c < 3u; ++c) add_to_record(first + voxel_field_emission + c, fixed_point(min(emission[c], 2047.0f), rounding));
    add_to_record(first + voxel_field_emissive_area, fixed_point(area, rounding));
}

/// `record`: the voxel's.
void sum(VoxelTriangle triangle, ivec3 voxel, uint record) {
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
    const vec3 position = clamp(part.xyz, 0.0f, 1.0f);
    const VoxelSums sums = find_sums(record);
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
        const float area = part.w * abs(along);
        const float shown = area * surface.cover;
        if (rear && !two_sided) {
            add_to_record((record * voxel_faces + face) * voxel_field_count + voxel_field_behind, fixed_point(shown, rounding));
            continue;
        }
        const uint place = sums.first + face * sums.stride;
        add(place + voxel_field_area, shown, rounding);
        add(place + voxel_field_albedo, area * surface.albedo, rounding);
        add(place + voxel_field_normal, (rear ? -shown : shown) * triangle.normal, rounding);
        add(place + voxel_field_position, shown * position, rounding);
        if (surface.specular > 0.0f) {
            add(place + voxel_field_specular, area * surface.specular, rounding);
            add(place + voxel_field_alpha, area * surface.specular * surface.alpha, rounding);
        }
        if (any(greaterThan(surface.emission, vec3(0.0f))))
            add_emission(record * voxel_faces + face, area * surface.emission, area * surface.opacity, rounding);
    }
}

#endif
