#version 460
#extension GL_GOOGLE_include_directive : require
// An invocation a triangle: small ones are drawn at once, others clipped where they must be, and listed as strips.
#include "passes/compute_raster/raster_triangle.glsl"
#include "passes/compute_raster/clip_triangle.glsl"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;

/// Where there is no room, the demand says so.
void list_strips(WindowTriangle window) {
    const uint place = atomicAdd(strips.large_demand, 1u);
    if (place < push.large_capacity) large[place] = window;
    const int count = (window.high.y - window.low.y) / raster_strip_rows + 1;
    const uint first = atomicAdd(strips.demand, uint(count));
    for (int i = 0; i < count && first + uint(i) < push.strip_capacity; ++i)
        strip[first + uint(i)] = uvec2(place, window.low.y + i * raster_strip_rows);
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
        window.view = i;
        const uint place = place_in(view, triangle, window);
        if (place == place_small) {
            draw_box(triangle, window, view);
        } else if (place == place_large) {
            list_strips(window);
        } else if (place == place_clipped) {
            const ClipPolygon polygon = clip_triangle(triangle, view.guard);
            for (int k = 2; k < polygon.count; ++k)
                if (to_window(polygon.corners[0], polygon.corners[k - 1], polygon.corners[k], view, window))
                    list_strips(window);
        }
    }
}
