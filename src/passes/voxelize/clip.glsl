// The part of a triangle that lies in a voxel: Sutherland & Hodgman 1974, "Reentrant Polygon Clipping".
#ifndef HELIODON_VOXEL_CLIP_GLSL
#define HELIODON_VOXEL_CLIP_GLSL

const int most_corners = 9;  // a triangle cut by six planes

/// Area and moment of a fan's triangle.
vec4 moment_and_area(vec3 a, vec3 b, vec3 c) {
    const float part = 0.5f * length(cross(b - a, c - a));
    return vec4(part * (a + b + c) * (1.0f / 3.0f), part);
}

/// xyz: centroid of the triangle's part in the voxel at `voxel`, relative to the voxel's low corner; w: its area.
vec4 centroid_and_area(vec3 p0, vec3 p1, vec3 p2, vec3 voxel) {
    const vec3 a = p0 - voxel;
    const vec3 b = p1 - voxel;
    const vec3 c = p2 - voxel;
    const vec3 low = min(a, min(b, c));
    const vec3 high = max(a, max(b, c));
    // A bit a plane that the triangle crosses: low x y z, high x y z.
    uint planes = 0u;
    for (uint axis = 0u; axis < 3u; ++axis)
        planes |= uint(low[axis] < 0.0f) << axis | uint(high[axis] > 1.0f) << (axis + 3u);
    vec4 sum = vec4(0.0f);
    if (planes == 0u) {
        sum = moment_and_area(a, b, c);
    } else {
        // Two polygons, the one before a cut and the one after it by turns.
        vec3 corners[2 * most_corners];
        corners[0] = a;
        corners[1] = b;
        corners[2] = c;
        int first = 0;
        int count = 3;
        while (planes != 0u && count > 0) {
            const int plane = findLSB(planes);
            planes &= planes - 1u;
            const int axis = plane % 3;
            const float at = plane < 3 ? 0.0f : 1.0f;
            const float side = plane < 3 ? -1.0f : 1.0f;  // kept: side · corner[axis] ≤ side · at
            const int kept_first = most_corners - first;
            int kept = 0;
            vec3 from = corners[first + count - 1];
            float from_outside = side * (from[axis] - at);
            for (int i = 0; i < count; ++i) {
                const vec3 to = corners[first + i];
                const float to_outside = side * (to[axis] - at);
                if (from_outside * to_outside < 0.0f && kept < most_corners) {
                    vec3 cut = mix(from, to, from_outside / (from_outside - to_outside));
                    cut[axis] = at;
                    corners[kept_first + kept++] = cut;
                }
                if (to_outside <= 0.0f && kept < most_corners) corners[kept_first + kept++] = to;
                from = to;
                from_outside = to_outside;
            }
            first = kept_first;
            count = kept;
        }
        for (int i = 2; i < count; ++i) sum += moment_and_area(corners[first], corners[first + i - 1], corners[first + i]);
    }
    return vec4(sum.w > 0.0f ? sum.xyz / sum.w : vec3(0.5f), sum.w);
}

#endif
