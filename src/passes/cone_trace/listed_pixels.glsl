// Pixels that trace cones of their own, in three lists: for diffuse light and for reflections those unlike the traced ones
// about them, or with a clear coat, and those that light comes through.
#ifndef HELIODON_LISTED_PIXELS_GLSL
#define HELIODON_LISTED_PIXELS_GLSL
#include "passes/voxelize/linear_groups.glsl"

const uint unlike_diffuse = 0u, unlike_specular = 1u, transmissive = 2u;
const uint listed_a_group = 32u;
layout(set = 0, binding = 17, std430) buffer Listed {
    uvec4 groups[3];  // x y z: VkDispatchIndirectCommand of workgroups of listed_a_group pixels, linear_group(); w: pixels
    uint pixels[];    // of the first list, then, a picture's pixels later each, of the others
} listed;

/// With whether the light of its specular lobe is known already.
uint pack_listed(ivec2 pixel, bool has_specular) { return uint(pixel.x) | uint(pixel.y) << 15u | uint(has_specular) << 31u; }
ivec2 listed_pixel(uint packed_pixel) { return ivec2(packed_pixel & 0x7fffu, (packed_pixel >> 15u) & 0x7fffu); }
bool listed_has_specular(uint packed_pixel) { return (packed_pixel >> 31u) != 0u; }
/// Entry `index` of a list; false past its end.
bool listed_entry(uint list, uint index, uint picture_pixels, out uint packed_pixel) {
    packed_pixel = 0u;
    if (index >= listed.groups[list].w) return false;
    packed_pixel = listed.pixels[list * picture_pixels + index];
    return true;
}

#endif
