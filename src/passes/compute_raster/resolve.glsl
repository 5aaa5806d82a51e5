// What the resolving shaders share: they leave the keys and the list of strips empty for the next time.
#ifndef HELIODON_RASTER_RESOLVE_GLSL
#define HELIODON_RASTER_RESOLVE_GLSL
#include "passes/compute_raster/compute_raster_shared.h"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 8, std430) readonly buffer Views { RasterView views[]; };
layout(set = 0, binding = 13, std430) buffer Keys { uvec2 keys[]; };  // low and high half
layout(set = 0, binding = 14, std430) buffer Strips { RasterStrips strips; };
layout(push_constant) uniform Push { ComputeRasterConstants push; };

/// Takes this invocation's key; false if it has none. `pixel`: in the picture, and the layer.
bool take_key(out uvec2 key, out ivec3 pixel) {
    const uint place = linear_invocation();
    if (place >= push.key_count) return false;
    if (place == 0u) strips = RasterStrips(0u, 0u);
    uint first = push.view_first;
    uint end = push.view_first + push.view_count;
    while (end - first > 1u) {
        const uint middle = (first + end) / 2u;
        if (views[middle].first_key <= place) first = middle;
        else end = middle;
    }
    const uint within = place - views[first].first_key;
    const uint width = views[first].width;
    pixel = ivec3(views[first].corner_x + within % width, views[first].corner_y + within / width, views[first].layer);
    key = keys[place];
    if (key.y != 0u) keys[place] = uvec2(0u);
    return true;
}

#endif
