// Rasterization by compute, in C++ and GLSL.
#ifndef HELIODON_PASSES_COMPUTE_RASTER_SHARED_H
#define HELIODON_PASSES_COMPUTE_RASTER_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

/// A rectangle of pixels that the scene is drawn to.
struct RasterView {
    mat4 world_to_clip;
    uint first_key;  // its pixels' keys lie row after row
    uint width;
    uint height;
    uint corner_x;  // in the picture or its layer of the shadow maps, pixels
    uint corner_y;
    uint layer;
    uint number;  // of the view, for random numbers
    float guard;  // triangles that reach out of the view by more than this factor are clipped
};

/// What is drawn together: views from `view_first` on.
struct ComputeRasterConstants {
    uint range_count;
    uint triangle_count;
    uint view_first;
    uint view_count;
    uint key_count;
    uint strip_capacity;
    uint random_seed;
};

/// First words of the list of strips; one uvec2 a strip follows: the triangle's number; bits 0 to 15 the strip, 16 to 31
/// the view, counted from view_first.
struct RasterStrips {
    uint demand;
    uint padding;
};

// Vertices snap to 1/256 pixel, as graphics hardware does (VkPhysicalDeviceLimits::subPixelPrecisionBits).
SHADING_CONST int raster_subpixels = 256;
// What a triangle's box of pixels may hold to be drawn by one invocation; others are drawn in strips, a workgroup each.
SHADING_CONST int raster_small_pixels = 64;
SHADING_CONST int raster_strip_rows = 16;
SHADING_CONST uint raster_views_a_thread = 6u;      // a cube's
SHADING_CONST uint raster_strip_groups = 4096u;     // they share the strips
SHADING_CONST uint raster_most_views = 65536u;      // drawn together

SHADING_END
#endif
