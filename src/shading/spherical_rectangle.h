// Sampling a rectangle by the solid angle under which it appears: Ureña, Fajardo & King 2013, "An Area-Preserving
// Parametrization for Spherical Rectangles".
#ifndef HELIODON_SHADING_SPHERICAL_RECTANGLE_H
#define HELIODON_SHADING_SPHERICAL_RECTANGLE_H
#include "shading/sampling.h"
SHADING_BEGIN

/// The rectangle in a frame at the viewpoint whose z looks away from its plane (section 3 of the paper).
struct SphericalRectangle {
    float x0;
    float y0;
    float z0;  // ≤ 0
    float x1;
    float y1;
    float b0;
    float b1;
    float k;
    float solid_angle;  // sr
};

/// Argument in [0, 2π) of the complex number, whose angles are as good near the axes as between them.
SHADING_FN float turn_of(vec2 number) {
    const float angle = angle_of(number.y, number.x);
    return angle < 0.0f ? angle + 2.0f * pi : angle;
}
SHADING_FN vec2 complex_product(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

/// Seen from where `to_origin` leads to a corner: two perpendicular edges, their lengths and the normal on either side.
SHADING_FN SphericalRectangle spherical_rectangle(vec3 to_origin, vec3 edge0, vec3 edge1, vec2 lengths, vec3 normal) {
    SphericalRectangle r;
    r.x0 = dot(to_origin, edge0) / lengths.x;
    r.y0 = dot(to_origin, edge1) / lengths.y;
    r.z0 = -abs(dot(to_origin, normal));
    r.x1 = r.x0 + lengths.x;
    r.y1 = r.y0 + lengths.y;
    // The planes through the viewpoint and each edge meet at a corner (x, y) under the argument of ±xy + i |z0| √(x² + y² + z0²),
    // from the cross and dot products of their normals; arguments add where complex numbers multiply.
    const float z2 = r.z0 * r.z0;
    const float x02 = r.x0 * r.x0 + z2;
    const float x12 = r.x1 * r.x1 + z2;
    const float y02 = r.y0 * r.y0;
    const float y12 = r.y1 * r.y1;
    const vec2 corner_10 = vec2(r.x1 * r.y0, -r.z0 * sqrt(x12 + y02));
    const vec2 corner_11 = vec2(-r.x1 * r.y1, -r.z0 * sqrt(x12 + y12));
    const vec2 corner_01 = vec2(r.x0 * r.y1, -r.z0 * sqrt(x02 + y12));
    const vec2 corner_00 = vec2(-r.x0 * r.y0, -r.z0 * sqrt(x02 + y02));
    const vec2 left = complex_product(corner_01, corner_00);
    r.b0 = -r.y0 * inversesqrt(z2 + y02);
    r.b1 = r.y1 * inversesqrt(z2 + y12);
    r.k = 2.0f * pi - turn_of(left);
    r.solid_angle = turn_of(complex_product(complex_product(corner_10, corner_11), left));
    return r;
}

/// Coordinates in [0, 1]² along the two edges of a point that is uniform in solid angle.
SHADING_FN vec2 sample_spherical_rectangle(SphericalRectangle r, vec2 u) {
    const float au = u.x * r.solid_angle + r.k;
    const float fu = (cos(au) * r.b0 - r.b1) / sin(au);
    const float cu = clamp((fu > 0.0f ? 1.0f : -1.0f) * inversesqrt(fu * fu + r.b0 * r.b0), -1.0f, 1.0f);
    const float xu = clamp(-(cu * r.z0) * inversesqrt(max(1.0f - cu * cu, 1.0e-12f)), r.x0, r.x1);
    const float d2 = xu * xu + r.z0 * r.z0;
    const float h0 = r.y0 * inversesqrt(d2 + r.y0 * r.y0);
    const float h1 = r.y1 * inversesqrt(d2 + r.y1 * r.y1);
    const float hv = h0 + u.y * (h1 - h0);
    const float yv = hv * hv < 1.0f - 1.0e-6f ? clamp(hv * sqrt(d2) * inversesqrt(1.0f - hv * hv), r.y0, r.y1) : r.y1;
    return vec2((xu - r.x0) / (r.x1 - r.x0), (yv - r.y0) / (r.y1 - r.y0));
}

SHADING_END
#endif
