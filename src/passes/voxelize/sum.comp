#version 460
#extension GL_GOOGLE_include_directive : require
// Sums the records: workgroups first take the tiles of large triangles, then the small ones. Neighbouring small triangles share voxels, so that
// a workgroup adds up what it can by itself.
#include "passes/voxelize/voxel_shared.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 16, std430) readonly buffer Numbers { VoxelHeader header; uint voxel_number[]; };
layout(set = 0, binding = 18, std430) buffer Records { uint records[]; };
layout(set = 0, binding = 19, std430) readonly buffer Tiles { VoxelTile tiles[]; };
#include "passes/voxelize/voxel_pieces.glsl"

// A table of faces by open addressing (Knuth 1998, "The Art of Computer Programming" 3, section 6.4, algorithm L) with
// his multiplicative hash.
const uint slot_bits = 7u;
const uint slots = 1u << slot_bits;
const uint most_probes = 8u;  // then the record itself is added to
const uint in_slot = 0x80000000u;
shared uint slot_face[slots];  // + 1; 0: empty
shared uint slot_sums[slots * voxel_field_count];
shared uint used_slot[slots];
shared uint used_count;

uint face_sums(uint face) {
    if (linear_group() >= header.tile_count)
        for (uint probe = 0u; probe < most_probes; ++probe) {
            const uint slot = ((face * 2654435769u >> (32u - slot_bits)) + probe) % slots;
            // Once it is there it stays: only what does not see it yet has to ask for it.
            if (slot_face[slot] == face + 1u) return in_slot | slot * voxel_field_count;
            const uint found = atomicCompSwap(slot_face[slot], 0u, face + 1u);
            if (found == 0u) used_slot[atomicAdd(used_count, 1u)] = slot;
            if (found == 0u || found == face + 1u) return in_slot | slot * voxel_field_count;
        }
    return face * voxel_field_count;
}
void add_to_sum(uint place, uint amount) {
    if ((place & in_slot) != 0u) atomicAdd(slot_sums[place & ~in_slot], amount);
    else atomicAdd(records[place], amount);
}
#include "passes/voxelize/voxel_sum.glsl"

void main() {
    const uint group = linear_group();
    const bool large = group < header.tile_count;
    const uint own = gl_LocalInvocationID.x;
    if (own == 0u) used_count = 0u;
    for (uint i = own; i < slots && !large; i += piece_invocations) slot_face[i] = 0u;
    for (uint i = own; i < slots * voxel_field_count && !large; i += piece_invocations) slot_sums[i] = 0u;
    VoxelTriangle triangle;
    bool left = large ? find_column(group, triangle)
                      : find_triangle((group - header.tile_count) * piece_invocations + own, triangle) && is_small(triangle);
    ivec3 voxel = triangle.low;
    do {
        begin_pieces();
        list_pieces(triangle, voxel, left);
        for (uint i = own; i < piece_count(); i += piece_invocations) {
            VoxelTriangle piece;
            const ivec3 at = find_piece(i, piece);
            const uint number = voxel_number[voxel_place(at)];
            if (number != 0u && number != voxel_without_room) sum(piece, at, number - 1u, own);
        }
    } while (unlisted != 0u);
    barrier();
    for (uint i = own; i < used_count * voxel_field_count; i += piece_invocations) {
        const uint slot = used_slot[i / voxel_field_count];
        const uint field = i % voxel_field_count;
        const uint amount = slot_sums[slot * voxel_field_count + field];
        if (amount != 0u) atomicAdd(records[(slot_face[slot] - 1u) * voxel_field_count + field], amount);
    }
}
