// What the resolving shaders share: they leave the keys and the list of strips empty for the next time. The includer
// defines resolve().
#ifndef HELIODON_RASTER_RESOLVE_GLSL
#define HELIODON_RASTER_RESOLVE_GLSL
#include "passes/compute_raster/compute_raster_shared.h"
#include "passes/voxelize/linear_groups.glsl"

const uint lanes = 64u;
layout(local_size_x = lanes) in;
layout(set = 0, binding = 8, std430) readonly buffer Views { RasterView views[]; };
layout(set = 0, binding = 13, std430) buffer Keys { uvec2 keys[]; };  // low and high half
layout(set = 0, binding = 14, std430) buffer Strips { RasterStrips strips; };
layout(push_constant) uniform Push { ComputeRasterConstants push; };

/// `pixel`: in the picture, and the layer.
void resolve(uvec2 key, ivec3 pixel);

/// The view that a block of keys is of.
RasterView view_of(uint first_key) {
    uint low = push.view_first;
    uint high = push.view_first + push.view_count;
    while (high - low > 1u) {
        const uint middle = (low + high) / 2u;
        if (views[middle].first_key <= first_key) low = middle;
        else high = middle;
    }
    return views[low];
}

void main() {
    const uint first_key = linear_group() * raster_key_block;
    if (first_key >= push.key_count) return;
    if (first_key == 0u && gl_LocalInvocationID.x == 0u) strips = RasterStrips(0u, 0u);
    const RasterView view = view_of(first_key);
    const uint within = first_key - view.first_key + gl_LocalInvocationID.x;
    uint x = within % view.width;
    uint y = within / view.width;
    for (uint i = 0u; i < raster_key_block && y < view.height; i += lanes) {
        const uint place = first_key + gl_LocalInvocationID.x + i;
        const uvec2 key = keys[place];
        if (key.y != 0u) keys[place] = uvec2(0u);
        resolve(key, ivec3(view.corner_x + x, view.corner_y + y, view.layer));
        for (x += lanes; x >= view.width; x -= view.width) ++y;
    }
}

#endif
