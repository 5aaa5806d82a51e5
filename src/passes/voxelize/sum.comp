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

// A table of voxels by open addressing (Knuth 1998, "The Art of Computer Programming" 3, section 6.4, algorithm L) with
// his multiplicative hash. It is small: memory that workgroups take keeps others from the same processor, which costs more
// than what finds no place in it and goes to its record (docs/performance.md).
const uint slot_bits = 3u;
const uint slots = 1u << slot_bits;
const uint in_slot = 0x80000000u;
const uint slot_fields = voxel_field_emission;  // those before it
const uint slot_words = voxel_faces * slot_fields;
shared uint slot_record[slots];  // + 1; 0: empty
shared uint slot_sums[slots * slot_words];

struct VoxelSums {
    uint first;
    uint stride;
};
VoxelSums find_sums(uint record) {
    if (linear_group() >= header.tile_count)
        for (uint probe = 0u; probe < slots; ++probe) {
            const uint slot = ((record * 2654435769u >> (32u - slot_bits)) + probe) % slots;
            // Once it is there it stays: only what finds the slot empty has to ask for it.
            uint found = slot_record[slot];
            if (found == 0u) found = atomicCompSwap(slot_record[slot], 0u, record + 1u);
            if (found == 0u || found == record + 1u) return VoxelSums(in_slot | slot * slot_words, slot_fields);
        }
    return VoxelSums(record * voxel_faces * voxel_field_count, voxel_field_count);
}
void add_to_record(uint word, uint amount) { atomicAdd(records[word], amount); }
void add_to_sum(uint place, uint amount) {
    if ((place & in_slot) != 0u) atomicAdd(slot_sums[place & ~in_slot], amount);
    else add_to_record(place, amount);
}
#include "passes/voxelize/voxel_sum.glsl"

void main() {
    const uint group = linear_group();
    const bool large = group < header.tile_count;
    const uint own = gl_LocalInvocationID.x;
    if (own < slots) slot_record[own] = 0u;
    for (uint i = own; i < slots * slot_words && !large; i += piece_invocations) slot_sums[i] = 0u;
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
            if (number != 0u && number != voxel_without_room) sum(piece, at, number - 1u);
        }
    } while (unlisted != 0u);
    barrier();
    for (uint i = own; i < slots * slot_words && !large; i += piece_invocations) {
        const uint amount = slot_sums[i];
        if (amount == 0u) continue;
        const uint face = (slot_record[i / slot_words] - 1u) * voxel_faces + i % slot_words / slot_fields;
        add_to_record(face * voxel_field_count + i % slot_fields, amount);
    }
}
