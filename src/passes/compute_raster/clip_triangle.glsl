// What of a triangle lies before the near plane and within the guard band: Sutherland & Hodgman 1974, "Reentrant
// Polygon Clipping". An edge is cut at the same place for both triangles that share it.
#ifndef HELIODON_CLIP_TRIANGLE_GLSL
#define HELIODON_CLIP_TRIANGLE_GLSL

const int most_clip_corners = 3 + clip_planes;

struct ClipPolygon {
    vec4 corners[most_clip_corners];
    int count;
};

ClipPolygon clip_by_plane(ClipPolygon polygon, int plane, float guard) {
    ClipPolygon kept;
    kept.count = 0;
    vec4 a = polygon.corners[polygon.count - 1];
    float inside_a = clip_distance(a, plane, guard);
    for (int i = 0; i < polygon.count; ++i) {
        const vec4 b = polygon.corners[i];
        const float inside_b = clip_distance(b, plane, guard);
        if ((inside_a < 0.0f) != (inside_b < 0.0f) && kept.count < most_clip_corners) {
            // From the inside to the outside, whichever way round the triangle goes.
            const vec4 from = inside_a < 0.0f ? b : a;
            const vec4 to = inside_a < 0.0f ? a : b;
            const float d_from = max(inside_a, inside_b);
            precise float share = d_from / (d_from - min(inside_a, inside_b));
            precise vec4 cut = from + (to - from) * share;
            kept.corners[kept.count++] = cut;
        }
        if (inside_b >= 0.0f && kept.count < most_clip_corners) kept.corners[kept.count++] = b;
        a = b;
        inside_a = inside_b;
    }
    return kept;
}

ClipPolygon clip_triangle(RasterTriangle triangle, float guard) {
    ClipPolygon polygon;
    for (int i = 0; i < 3; ++i) polygon.corners[i] = triangle.clip[i];
    polygon.count = 3;
    uint planes = 0u;
    for (int i = 0; i < 3; ++i) planes |= outside_clip(triangle.clip[i], guard);
    while (planes != 0u && polygon.count > 0) {
        polygon = clip_by_plane(polygon, findLSB(planes), guard);
        planes &= planes - 1u;
    }
    return polygon;
}

#endif
