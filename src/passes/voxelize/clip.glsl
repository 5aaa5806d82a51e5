// The part of a triangle that lies in a voxel: Sutherland & Hodgman 1974, "Reentrant Polygon Clipping".
#ifndef HELIODON_VOXEL_CLIP_GLSL
#define HELIODON_VOXEL_CLIP_GLSL

const int most_corners = 9;  // a triangle cut by six planes

struct Polygon {
    vec3 corners[most_corners];
    int count;
};

/// What is left where `side` · corner[axis] ≤ side · plane.
Polygon clip_half_space(Polygon polygon, int axis, float plane, float side) {
    Polygon kept;
    kept.count = 0;
    vec3 a = polygon.corners[polygon.count - 1];
    float outside_a = side * (a[axis] - plane);
    for (int i = 0; i < polygon.count; ++i) {
        const vec3 b = polygon.corners[i];
        const float outside_b = side * (b[axis] - plane);
        if (outside_a * outside_b < 0.0f && kept.count < most_corners) {
            vec3 cut = mix(a, b, outside_a / (outside_a - outside_b));
            cut[axis] = plane;
            kept.corners[kept.count++] = cut;
        }
        if (outside_b <= 0.0f && kept.count < most_corners) kept.corners[kept.count++] = b;
        a = b;
        outside_a = outside_b;
    }
    return kept;
}

/// xyz: centroid of the triangle's part in the voxel at `voxel`, relative to the voxel's low corner; w: its area.
vec4 centroid_and_area(vec3 p0, vec3 p1, vec3 p2, vec3 voxel) {
    Polygon polygon;
    polygon.corners[0] = p0 - voxel;
    polygon.corners[1] = p1 - voxel;
    polygon.corners[2] = p2 - voxel;
    polygon.count = 3;
    const vec3 low = min(polygon.corners[0], min(polygon.corners[1], polygon.corners[2]));
    const vec3 high = max(polygon.corners[0], max(polygon.corners[1], polygon.corners[2]));
    // A bit a plane that the triangle crosses: low x y z, high x y z.
    uint planes = 0u;
    for (uint axis = 0u; axis < 3u; ++axis)
        planes |= uint(low[axis] < 0.0f) << axis | uint(high[axis] > 1.0f) << (axis + 3u);
    while (planes != 0u && polygon.count > 0) {
        const int plane = findLSB(planes);
        planes &= planes - 1u;
        polygon = clip_half_space(polygon, plane % 3, plane < 3 ? 0.0f : 1.0f, plane < 3 ? -1.0f : 1.0f);
    }
    vec3 moment = vec3(0.0f);
    float area = 0.0f;
    for (int i = 2; i < polygon.count; ++i) {
        const vec3 a = polygon.corners[0];
        const float part = 0.5f * length(cross(polygon.corners[i - 1] - a, polygon.corners[i] - a));
        moment += part * (a + polygon.corners[i - 1] + polygon.corners[i]) * (1.0f / 3.0f);
        area += part;
    }
    return vec4(area > 0.0f ? moment / area : vec3(0.5f), area);
}

#endif
