#version 460
#extension GL_GOOGLE_include_directive : require
// Draws the strips of large triangles, a workgroup each. Where there was no room to list them all, every large triangle
// is looked for again: to draw a pixel twice changes nothing.
#include "passes/compute_raster/raster_triangle.glsl"
#include "passes/compute_raster/clip_triangle.glsl"

layout(local_size_x = 64) in;
const int lanes = 32;  // neighbouring pixels of a row, whose keys lie side by side
const int rows_at_once = 2;

/// Narrows the pixels of a row to those where an edge's function can be positive; one more, for rounding.
void narrow(Edge edge, int low_x, inout ivec2 span) {
    if (edge.step_x == 0l) {
        if (edge.at < 0l) span.y = span.x - 1;
        return;
    }
    const float crossing = clamp(float(low_x) - float(edge.at) / float(edge.step_x), -1.0e6f, 1.0e6f);
    if (edge.step_x > 0l) span.x = max(span.x, int(floor(crossing)) - 1);
    else span.y = min(span.y, int(ceil(crossing)) + 1);
}

void draw_rows(RasterTriangle triangle, WindowTriangle window, RasterView view, ivec2 rows) {
    const ivec2 first = ivec2(window.low.x, max(window.low.y, rows.x) + int(gl_LocalInvocationID.x) / lanes);
    const int last_row = min(window.high.y, rows.y);
    Edge ab = edge_at(window.a, window.b, first);
    Edge bc = edge_at(window.b, window.c, first);
    Edge ca = edge_at(window.c, window.a, first);
    for (int y = first.y; y <= last_row; y += rows_at_once) {
        ivec2 span = ivec2(window.low.x, window.high.x);
        narrow(ab, first.x, span);
        narrow(bc, first.x, span);
        narrow(ca, first.x, span);
        // From where a lane's worth of keys shares a sector of memory.
        const int begin = (span.x & ~3) + int(gl_LocalInvocationID.x) % lanes;
        const int64_t skipped = int64_t(begin - first.x);
        int64_t e0 = ab.at + skipped * ab.step_x;
        int64_t e1 = bc.at + skipped * bc.step_x;
        int64_t e2 = ca.at + skipped * ca.step_x;
        for (int x = begin; x <= span.y; x += lanes) {
            if ((e0 | e1 | e2) >= 0l && x >= span.x) draw(triangle, window, view, ivec2(x, y));
            e0 += ab.step_x * lanes;
            e1 += bc.step_x * lanes;
            e2 += ca.step_x * lanes;
        }
        ab.at += ab.step_y * rows_at_once;
        bc.at += bc.step_y * rows_at_once;
        ca.at += ca.step_y * rows_at_once;
    }
}

void draw_listed() {
    for (uint i = gl_WorkGroupID.x; i < strips.demand; i += gl_NumWorkGroups.x) {
        const WindowTriangle window = large[strip[i].x];
        const RasterView view = views[push.view_first + window.view];
        RasterTriangle triangle;
        if (tests_opacity) {
            triangle = load_triangle(window.number);
            project(triangle, view);
        }
        const int first_row = int(strip[i].y);
        draw_rows(triangle, window, view, ivec2(first_row, first_row + raster_strip_rows - 1));
    }
}

void draw_all() {
    for (uint i = gl_WorkGroupID.x; i < push.triangle_count * push.view_count; i += gl_NumWorkGroups.x) {
        const RasterView view = views[push.view_first + i % push.view_count];
        RasterTriangle triangle = load_triangle(i / push.view_count);
        WindowTriangle window;
        const uint place = place_in(view, triangle, window);
        if (place != place_large && place != place_clipped) continue;
        ClipPolygon polygon;
        polygon.count = 3;
        if (place == place_clipped) polygon = clip_triangle(triangle, view.guard);
        for (int k = 2; k < polygon.count; ++k) {
            if (place == place_clipped &&
                !to_window(polygon.corners[0], polygon.corners[k - 1], polygon.corners[k], view, window))
                continue;
            draw_rows(triangle, window, view, ivec2(window.low.y, window.high.y));
        }
    }
}

void main() {
    if (strips.demand <= push.strip_capacity && strips.large_demand <= push.large_capacity) draw_listed();
    else draw_all();
}
