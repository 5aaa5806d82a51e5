// A workgroup's triangles with the voxels that they may pass through: pairs are listed first and then shared evenly among
// its invocations, however many voxels each triangle has. The includer defines `header` and `tiles`.
#ifndef HELIODON_VOXEL_PIECES_GLSL
#define HELIODON_VOXEL_PIECES_GLSL
#include "passes/voxelize/voxel_walk.glsl"

const uint piece_invocations = 64u;  // of the workgroup
// Voxels of each triangle in a list: few triangles have more. Of a box of eight at most the second four lie nowhere before
// the first of them.
const uint turn_voxels = small_triangle_voxels / 2u;
const uint most_pieces = piece_invocations * turn_voxels;

shared uvec2 piece_source[piece_invocations];  // instance, primitive
shared vec3 piece_p0[piece_invocations];
shared vec3 piece_p1[piece_invocations];
shared vec3 piece_p2[piece_invocations];
shared vec3 piece_normal[piece_invocations];
shared uint piece_low[piece_invocations];  // ten bits an axis
// invocation, and three bits an axis: the voxel from piece_low. Those that need no clipping from the front, others from
// the rear: neighbours take the same way.
shared uint pieces[most_pieces];
shared uint whole_count;
shared uint cut_count;
shared uint unlisted;

/// Leaves room for the next list; to be called by all.
void begin_pieces() {
    barrier();
    if (gl_LocalInvocationID.x == 0u) whole_count = cut_count = unlisted = 0u;
    barrier();
}

/// Lists this invocation's triangle with the voxels of its box from `voxel`, which goes on to the first one that was not
/// listed; `left`: whether there is one. To be called by all, those without a triangle with nothing left.
void list_pieces(VoxelTriangle triangle, inout ivec3 voxel, inout bool left) {
    const uint own = gl_LocalInvocationID.x;
    if (left) {
        const ivec3 low = voxel;
        // A bit a voxel: counted first, so that one atomic operation makes room for all.
        uint near = 0u;
        for (uint i = 0u; i < turn_voxels && left; ++i) {
            near |= uint(near_plane(triangle, voxel)) << i;
            left = next_voxel(triangle, voxel);
        }
        if (left) unlisted = 1u;
        piece_source[own] = uvec2(triangle.instance, triangle.primitive);
        piece_p0[own] = triangle.p0;
        piece_p1[own] = triangle.p1;
        piece_p2[own] = triangle.p2;
        piece_normal[own] = triangle.normal;
        piece_low[own] = uint(low.z) << 20u | uint(low.y) << 10u | uint(low.x);
        const uint count = bitCount(near);
        uint place = all(equal(triangle.low, triangle.high)) ? atomicAdd(whole_count, count)
                                                             : most_pieces - count - atomicAdd(cut_count, count);
        for (ivec3 at = low; near != 0u; near >>= 1u) {
            const uvec3 from = uvec3(at - low);
            if ((near & 1u) != 0u) pieces[place++] = own << 9u | from.z << 6u | from.y << 3u | from.x;
            next_voxel(triangle, at);
        }
    }
    barrier();
}

uint piece_count() { return whole_count + cut_count; }

/// Of `number` in the list; returns the voxel.
ivec3 find_piece(uint number, out VoxelTriangle triangle) {
    const uint piece = pieces[number < whole_count ? number : most_pieces - 1u - (number - whole_count)];
    const uint of = piece >> 9u;
    triangle.instance = piece_source[of].x;
    triangle.primitive = piece_source[of].y;
    triangle.p0 = piece_p0[of];
    triangle.p1 = piece_p1[of];
    triangle.p2 = piece_p2[of];
    triangle.normal = piece_normal[of];
    const uint low = piece_low[of];
    triangle.low = ivec3((low & 1023u) + (piece & 7u), (low >> 10u & 1023u) + (piece >> 3u & 7u), (low >> 20u) + (piece >> 6u & 7u));
    triangle.high = triangle.low;
    return triangle.low;
}

#endif
