// Sampling a rectangle by the solid angle under which it appears: Ureña, Fajardo & King 2013, "An Area-Preserving
// Parametrization for Spherical Rectangles".
#ifndef HELIODON_SHADING_SPHERICAL_RECTANGLE_H
#define HELIODON_SHADING_SPHERICAL_RECTANGLE_H
#include "shading/sampling.h"
SHADING_BEGIN

/// The rectangle in a frame at the viewpoint whose z looks away from its plane (section 3 of the paper).
struct SphericalRectangle {
    vec3 x;
    float x0;
    vec3 y;
    float y0;
    vec3 z;
    float z0;  // ≤ 0
    float x1;
    float y1;
    float b0;
    float b1;
    float k;
    float solid_angle;  // sr
};

/// Angle between a face normal and the next one's opposite. By the arctangent, since the arccosine loses
/// half its digits where the viewpoint is near the plane.
SHADING_FN float spherical_corner(vec3 n, vec3 next) { return atan(length(cross(n, next)), -dot(n, next)); }

/// Seen from `from`: the corner `origin` and two perpendicular edges.
SHADING_FN SphericalRectangle spherical_rectangle(vec3 origin, vec3 edge0, vec3 edge1, vec3 from) {
    SphericalRectangle r;
    const float length0 = length(edge0);
    const float length1 = length(edge1);
    r.x = edge0 / length0;
    r.y = edge1 / length1;
    r.z = cross(r.x, r.y);
    const vec3 d = origin - from;
    r.z0 = dot(d, r.z);
    if (r.z0 > 0.0f) {
        r.z = -r.z;
        r.z0 = -r.z0;
    }
    r.x0 = dot(d, r.x);
    r.y0 = dot(d, r.y);
    r.x1 = r.x0 + length0;
    r.y1 = r.y0 + length1;
    // Normals of the planes through the viewpoint and each edge; the y and x parts are the plane's z0.
    const vec3 n0 = vec3(0.0f, r.z0, -r.y0) * inversesqrt(r.z0 * r.z0 + r.y0 * r.y0);
    const vec3 n1 = vec3(-r.z0, 0.0f, r.x1) * inversesqrt(r.z0 * r.z0 + r.x1 * r.x1);
    const vec3 n2 = vec3(0.0f, -r.z0, r.y1) * inversesqrt(r.z0 * r.z0 + r.y1 * r.y1);
    const vec3 n3 = vec3(r.z0, 0.0f, -r.x0) * inversesqrt(r.z0 * r.z0 + r.x0 * r.x0);
    r.b0 = n0.z;
    r.b1 = n2.z;
    r.k = 2.0f * pi - spherical_corner(n2, n3) - spherical_corner(n3, n0);
    r.solid_angle = spherical_corner(n0, n1) + spherical_corner(n1, n2) - r.k;
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
