#version 460
#extension GL_GOOGLE_include_directive : require
// An invocation a triangle: small ones are drawn at once, others listed as strips.
#include "passes/voxelize/linear_groups.glsl"
#include "passes/compute_raster/raster_triangle.glsl"

layout(local_size_x = 64) in;

void list_strips(uint number, uint view, ivec2 rows) {
    const uint first_strip = uint(rows.x / raster_strip_rows);
    const uint count = uint(rows.y / raster_strip_rows) - first_strip + 1u;
    const uint place = atomicAdd(strips.demand, count);
    const uint room = push.strip_capacity - min(place, push.strip_capacity);
    for (uint i = 0u; i < min(count, room); ++i) strip[place + i] = uvec2(number, view << 16 | (first_strip + i));
}

void main() {
    const uint number = linear_invocation();
    if (number >= push.triangle_count) return;
    RasterTriangle triangle = load_triangle(number);
    const uint first = gl_WorkGroupID.z * raster_views_a_thread;
    const uint end = min(first + raster_views_a_thread, push.view_count);
    for (uint i = first; i < end; ++i) {
        const RasterView view = views[push.view_first + i];
        WindowTriangle window;
        switch (place_in(view, triangle, window)) {
            case place_small: draw_box(triangle, window, view); break;
            case place_large: list_strips(number, i, ivec2(window.low.y, window.high.y)); break;
            case place_clipped: list_strips(number, i, ivec2(0, int(view.height) - 1)); break;  // its box is not known yet
        }
    }
}
