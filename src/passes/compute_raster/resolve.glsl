// What the resolving shaders share: they leave the keys and the list of strips empty for the next time. The includer
// defines resolve().
#ifndef HELIODON_RASTER_RESOLVE_GLSL
#define HELIODON_RASTER_RESOLVE_GLSL
#include "passes/compute_raster/compute_raster_shared.h"
#include "passes/voxelize/linear_groups.glsl"

// Neighbouring lanes take neighbouring columns of two rows: images keep such squares together.
layout(local_size_x = raster_tile_edge, local_size_y = 4) in;
layout(set = 0, binding = 8, std430) readonly buffer Views { RasterView views[]; };
layout(set = 0, binding = 13, std430) buffer Keys { uvec2 keys[]; };  // low and high half
layout(set = 0, binding = 14, std430) buffer Strips { RasterStrips strips; };
layout(push_constant) uniform Push { ComputeRasterConstants push; };

/// `pixel`: in the picture, and the layer.
void resolve(uvec2 key, ivec3 pixel);

RasterView view_of(uint tile) {
    uint low = push.view_first;
    uint high = push.view_first + push.view_count;
    while (high - low > 1u) {
        const uint middle = (low + high) / 2u;
        if (views[middle].first_tile <= tile) low = middle;
        else high = middle;
    }
    return views[low];
}

void main() {
    uint tile = linear_group();
    if (tile >= push.tile_count) return;
    if (tile == 0u && gl_LocalInvocationIndex == 0u) strips = RasterStrips(0u, 0u);
    const RasterView view = view_of(tile);
    tile -= view.first_tile;
    const uint tiles_a_row = (view.width + raster_tile_edge - 1u) / raster_tile_edge;
    const uint x = tile % tiles_a_row * raster_tile_edge + gl_LocalInvocationID.x;
    const uint first_row = tile / tiles_a_row * raster_tile_edge;
    if (x >= view.width) return;
    const uint end = min(first_row + raster_tile_edge, view.height);
    for (uint y = first_row + gl_LocalInvocationID.y; y < end; y += gl_WorkGroupSize.y) {
        const uint place = view.first_key + y * view.width + x;
        const uvec2 key = keys[place];
        if (key.y != 0u) keys[place] = uvec2(0u);
        resolve(key, ivec3(view.corner_x + x, view.corner_y + y, view.layer));
    }
}

#endif
