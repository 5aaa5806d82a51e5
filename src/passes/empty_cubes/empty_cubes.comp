#version 460
#extension GL_GOOGLE_include_directive : require
// One step towards the largest empty cubes: eight of a step make up one of the next where they overlap.
#include "passes/empty_cubes/empty_cubes_shared.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 20, rgba16f) uniform readonly image3D faces;  // of level 2
layout(set = 0, binding = 23, std430) buffer Cubes { uint cubes[]; };
layout(push_constant) uniform Push { EmptyCubesConstants push; };

uint word_index(ivec3 cell) { return uint(cell.x + int(push.size) * (cell.y + int(push.size) * cell.z)); }

/// Bit octant: whether the cell shows anything to those who go there, that is, on the sides that look against them.
uint occupied_octants(ivec3 cell) {
    const uint to_greater[3] = uint[](0x55u, 0x33u, 0x0fu);  // octants that go to greater x, y, z
    uint occupied = 0u;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const ivec3 corner = int(push.size) * ivec3(side, 0, axis) + ivec3(0, int(push.first_row), 0);
            if (imageLoad(faces, corner + cell).a > 0.0f) occupied |= side == 1 ? to_greater[axis] : 0xffu ^ to_greater[axis];
        }
    return occupied;
}

bool reaches(ivec3 cell, uint octant, uint cube_step) {
    // Beyond the lattice there is nothing.
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(push.size)))) return true;
    return (cubes[word_index(cell)] >> (4u * octant) & 15u) >= cube_step;
}

// Others of the same dispatch may have gone one step further meanwhile, which answers reaches() alike.
bool grows(ivec3 cell, uint octant) {
    const int shift = int(cube_edge(push.step) - cube_edge(push.step - 1u));
    const ivec3 onward = shift * (1 - 2 * ivec3(octant & 1u, octant >> 1u & 1u, octant >> 2u));
    for (uint i = 7u; i > 0u; --i)
        if (!reaches(cell + onward * ivec3(i & 1u, i >> 1u & 1u, i >> 2u), octant, push.step - 1u)) return false;
    return true;
}

void main() {
    const ivec3 cell = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(cell, ivec3(push.size)))) return;
    uint word = push.step == 1u ? 0u : cubes[word_index(cell)];
    const uint before = word;
    const uint occupied = push.step == 1u ? occupied_octants(cell) : 0u;
    for (uint octant = 0u; octant < 8u; ++octant) {
        const bool first = push.step == 1u && (occupied >> octant & 1u) == 0u;
        const bool next = push.step > 1u && (before >> (4u * octant) & 15u) == push.step - 1u && grows(cell, octant);
        if (first || next) word += 1u << (4u * octant);
    }
    if (word != before || push.step == 1u) cubes[word_index(cell)] = word;
}
