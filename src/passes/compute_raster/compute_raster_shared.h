// Rasterization by compute, in C++ and GLSL.
#ifndef HELIODON_PASSES_COMPUTE_RASTER_SHARED_H
#define HELIODON_PASSES_COMPUTE_RASTER_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

/// A rectangle of pixels that the scene is drawn to.
struct RasterView {
    mat4 world_to_clip;
    uint first_key;   // its pixels' keys lie row after row
    uint first_tile;  // squares of raster_tile_edge² pixels in which keys are resolved, counted row after row
    uint width;
    uint height;
    uint corner_x;  // in the picture or its layer of the shadow maps, pixels
    uint corner_y;
    uint layer;
    uint number;  // of the view, for random numbers
    float guard;  // triangles that reach out of the view by more than this factor are clipped
    uint padding0;
    uint padding1;
    uint padding2;
};

/// What is drawn together: views from `view_first` on.
struct ComputeRasterConstants {
    uint range_count;
    uint triangle_count;
    uint view_first;
    uint view_count;
    uint tile_count;
    uint strip_capacity;
    uint large_capacity;
    uint random_seed;
};

/// A triangle, or what clipping left of it, in the window of a view.
struct WindowTriangle {
    ivec2 a;  // corners in sub-pixels, y down
    ivec2 b;  // clockwise
    ivec2 c;
    vec2 slope;   // of the depth, a pixel
    vec3 depth;   // of the corners
    uint number;  // of the triangle in the ranges
    ivec2 low;    // pixels whose centres its box holds, within the view: first and last
    ivec2 high;
    uint view;  // counted from view_first
    uint padding0;
    uint padding1;
    uint padding2;
};

/// First words of the list of strips; one uvec2 a strip follows: its large triangle, and its first row.
struct RasterStrips {
    uint demand;
    uint large_demand;  // large triangles
};

// Vertices snap to 1/256 pixel, as graphics hardware does (VkPhysicalDeviceLimits::subPixelPrecisionBits).
SHADING_CONST int raster_subpixels = 256;
// What a triangle's box of pixels may hold to be drawn by one invocation; others are drawn in strips, a workgroup each.
SHADING_CONST int raster_small_pixels = 256;
SHADING_CONST int raster_strip_rows = 16;
SHADING_CONST uint raster_views_a_thread = 6u;      // a cube's
SHADING_CONST uint raster_tile_edge = 16u;          // a workgroup resolves so many columns and rows
SHADING_CONST uint raster_strip_groups = 16384u;    // they share the strips

SHADING_END
#endif
