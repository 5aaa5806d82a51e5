// Faces within thin solids: the floor under a wall that stands on it. What is closed shows nothing to its inside, so that
// cones from there would go out through the wall and bring to one side the light of the other. Under thick solids no voxel
// but coarse ones mixes both sides, and what lies at their edge is better lit like the surface beside it than black.
#ifndef HELIODON_ENCLOSED_FACES_GLSL
#define HELIODON_ENCLOSED_FACES_GLSL
#include "passes/inject/record_work.glsl"

const int enclosed_reach = 4;      // voxels to each side
const float most_of_a_face = 0.5f;  // of a voxel: less may be the voxel's share of a surface that passes by

/// From behind too: a sheet shows both sides alike and leads nowhere.
float shown_area(uint number, uint face) {
    const uint first = ((number - 1u) * voxel_faces + face) * voxel_field_count;
    return float(records[first + voxel_field_area] + records[first + voxel_field_behind]) / voxel_fixed_one;
}

/// Whether who goes from a voxel along an axis meets the outer side of a solid from behind, before it could have entered it.
bool leaves_solid(ivec3 voxel, int axis, uint side, int size) {
    const uint along = 2u * uint(axis) + side;
    ivec3 step = ivec3(0);
    step[axis] = side == 0u ? 1 : -1;
    float left = 0.0f;  // faces gone out of less those gone into
    for (int i = 0; i <= enclosed_reach; ++i, voxel += step) {
        if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, ivec3(size)))) return false;
        const uint number = voxel_number[voxel.x + size * (voxel.y + size * voxel.z)];
        if (number == 0u || number == voxel_without_room) continue;
        left -= shown_area(number, along ^ 1u);
        if (i > 0) left += shown_area(number, along);
        if (abs(left) > most_of_a_face) return left > 0.0f;
    }
    return false;
}

/// Whether a thin solid encloses what is in front of a face: across the face's axis two opposite ways lead out of it.
bool is_enclosed(ivec3 voxel, uint face, int size) {
    const int axis = int(face >> 1u);
    voxel[axis] += (face & 1u) == 0u ? 1 : -1;
    for (int across = 1; across <= 2; ++across)
        if (leaves_solid(voxel, (axis + across) % 3, 0u, size) && leaves_solid(voxel, (axis + across) % 3, 1u, size)) return true;
    return false;
}

#endif
