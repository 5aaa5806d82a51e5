// Pixels that trace cones of their own, in two lists: those unlike the traced ones about them or with a clear coat, and
// those that light comes through.
#ifndef HELIODON_LISTED_PIXELS_GLSL
#define HELIODON_LISTED_PIXELS_GLSL
#include "passes/voxelize/linear_groups.glsl"

const uint unlike = 0u;
const uint transmissive = 1u;
layout(set = 0, binding = 17, std430) buffer Listed {
    uvec4 groups[2];  // x y z: VkDispatchIndirectCommand of workgroups of 32 pixels, linear_group(); w: pixels
    uint pixels[];    // of the first list, then, a picture's pixels later, of the second
} listed;

/// With what of its light is known already.
uint pack_listed(ivec2 pixel, bool has_diffuse, bool has_specular) {
    return uint(pixel.x) | uint(pixel.y) << 15u | uint(has_diffuse) << 30u | uint(has_specular) << 31u;
}
ivec2 listed_pixel(uint packed_pixel) { return ivec2(packed_pixel & 0x7fffu, (packed_pixel >> 15u) & 0x7fffu); }
bool listed_has_diffuse(uint packed_pixel) { return (packed_pixel >> 30u & 1u) != 0u; }
bool listed_has_specular(uint packed_pixel) { return (packed_pixel >> 31u) != 0u; }

#endif
