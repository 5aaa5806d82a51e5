// The voxel volume, in C++ and GLSL: its grids, and what one occupied voxel keeps of the surfaces in it.
#ifndef HELIODON_PASSES_VOXEL_SHARED_H
#define HELIODON_PASSES_VOXEL_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

/// A cube of size³ voxels: one cascade of the volume.
struct VoxelGrid {
    vec3 origin;          // world position of the lattice that the voxels are part of
    float voxel_m;        // edge of a voxel
    uint size;            // voxels an edge, a power of two
    float emission_unit;  // cd/m² that fixed-point emission 1 stands for
    float radiance_unit;  // cd/m² that 1 in the volume's textures stands for
    float snap;           // corners of triangles are rounded to multiples of it (voxels); 0: not at all
    ivec3 base;           // voxel (0, 0, 0) is voxel `base` of the lattice
    uint padding;
};
// Sums of a grid that moves by whole voxels stay the same bit for bit where corners in the lattice and in the grid are
// exact alike: multiples of `snap`, as fine as single precision has them everywhere in the lattice.

SHADING_CONST uint most_cascades = 8u;
SHADING_CONST uint most_coarse_levels = 9u;  // 512 voxels an edge have levels 1 to 9

/// First words of the numbering buffer of a cascade: counts, and arguments of the dispatches that follow from them.
/// voxel_number[size³] comes after it: 0 for an empty voxel, else its record + 1, or voxel_without_room.
struct VoxelHeader {
    uint record_demand;  // occupied voxels
    uint record_count;   // of them, those that found room
    uint tile_demand;    // tiles of large triangles
    uint tile_count;     // of them, those that found room
    uvec4 tile_groups;   // VkDispatchIndirectCommand: one workgroup a tile
    uvec4 record_groups; // VkDispatchIndirectCommand: groups of 64 invocations, one a record
    uint carried_without_room;  // voxels that had found no room where the carried ones come from
    uint carried_tile_demand;   // the most tiles that were wanted there
    uint padding0;
    uint padding1;
};

SHADING_CONST uint voxel_without_room = 0xffffffffu;  // occupied, but there are no more records

/// First words of the list of coarse voxels that hold anything: for level l (1 …), x y z: VkDispatchIndirectCommand of
/// groups of 64 invocations, one a voxel of the list; w: their number. The lists of linear voxel indices
/// (x + n (y + n z), n = size >> level) follow one another from voxel_level_first(level).
struct VoxelLevelsHeader {
    uvec4 groups[10];  // [0] is unused
};
/// Where the list of a level begins, in words after the header. `capacity` records at most.
SHADING_FN uint voxel_level_first(uint level, uint size, uint capacity) {
    uint first = 0u;
    for (uint l = 1u; l < level; ++l) {
        uint n = size >> l;
        first += min(capacity, n * n * n);
    }
    return first;
}

/// Words of a level's voxels at a bit each.
SHADING_FN uint voxel_bit_words(uint size) {
    return (size * size * size + 31u) / 32u;
}

/// Sixty-four columns of voxels under a large triangle, along the dominant axis of its normal.
struct VoxelTile {
    uint instance;
    uint primitive;
    uint column_u;  // first column, in the triangle's own frame: (axis + 1) % 3
    uint column_v;  // (axis + 2) % 3
};
SHADING_CONST uint voxel_tile_edge = 8u;

/// A material as voxels know it. Shares are of the surface's area.
struct VoxelSurface {
    vec3 albedo;    // share of arriving light that is reflected
    float cover;    // that stops light
    vec3 emission;  // in units of the grid's
    float opacity;  // there at all
    uint flags;     // voxel_surface_…
    float specular;  // of the albedo, mean of its channels
    float alpha;     // of what is specular
    uint padding;
};
SHADING_CONST uint voxel_surface_varies = 1u;  // from place to place: each piece of a triangle has its own
SHADING_CONST uint voxel_surface_two_sided = 2u;
SHADING_CONST uint voxel_surface_closed = 4u;  // of a mesh that encloses volumes
/// Instances before this one have their surface evaluated once if it does not vary, later ones at each piece.
SHADING_CONST uint most_even_surfaces = 16384u;

SHADING_CONST uint small_triangle_voxels = 8u;  // a triangle whose box has more is split into tiles

/// Dispatches of more workgroups than every device takes along x are spread over rows of so many; shaders then
/// count by linear_groups.glsl.
SHADING_CONST uint groups_a_row = 65535u;

struct VoxelizeConstants {
    VoxelGrid grid;
    uint range_count;
    uint triangle_count;
    uint record_capacity;
    uint tile_capacity;
    uint over_tiles;    // mark: the tiles of large triangles, not all triangles; arguments: of what goes over tiles alone
    float dilation_px;  // raster: half a pixel and what rounding can take, where the hardware does not find all pixels
    uint padding0;
    uint padding1;
    ivec3 shift;        // voxel v of this grid was voxel v + shift of the grid that voxels are carried from
    uint entered_only;  // triangles count in voxels alone that the other grid did not have
};

// A record has six faces (+x −x +y −y +z −z). A surface counts for the faces that it is seen from, with the area
// that it shows them. What one-sided surfaces of meshes that do not close show their rear is summed apart: it blocks light.
// Sums are fixed point, so that their order does not matter.
SHADING_CONST uint voxel_faces = 6u;
SHADING_CONST uint voxel_field_area = 0u;  // projected, in faces of a voxel
SHADING_CONST uint voxel_field_albedo = 1u;
SHADING_CONST uint voxel_field_normal = 4u;    // signed
SHADING_CONST uint voxel_field_position = 7u;  // in the voxel, 0 … 1
SHADING_CONST uint voxel_field_specular = 10u;  // of the albedo
SHADING_CONST uint voxel_field_alpha = 11u;     // weighted by that
SHADING_CONST uint voxel_field_emission = 12u;  // from here on nothing but zeros for what does not emit
SHADING_CONST uint voxel_field_emissive_area = 15u;
SHADING_CONST uint voxel_field_behind = 16u;  // area of what it sees from behind
SHADING_CONST uint voxel_field_count = 17u;
SHADING_CONST float voxel_fixed_one = 1048576.0f;  // 2²⁰: 4095 voxel faces of area before a sum is full

SHADING_END
#endif
