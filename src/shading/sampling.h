// Frames and the warps from the unit square to directions, each with its density per steradian.
#ifndef HELIODON_SHADING_SAMPLING_H
#define HELIODON_SHADING_SAMPLING_H
#include "core/units.h"
#include "shading/language.h"
SHADING_BEGIN

#ifdef __cplusplus
using units::luminance;
#endif

SHADING_CONST float pi = 3.14159265358979f;
SHADING_CONST float inverse_pi = 0.318309886183791f;

/// Right-handed orthonormal axes; `normal` is the local z.
struct Frame {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3.
SHADING_FN Frame frame_from_normal(vec3 n) {
    float s = n.z >= 0.0f ? 1.0f : -1.0f;
    float a = -1.0f / (s + n.z);
    float b = n.x * n.y * a;
    Frame frame;
    frame.tangent = vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    frame.bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    frame.normal = n;
    return frame;
}
SHADING_FN vec3 to_world(Frame frame, vec3 v) {
    return frame.tangent * v.x + frame.bitangent * v.y + frame.normal * v.z;
}
SHADING_FN vec3 to_local(Frame frame, vec3 v) {
    return vec3(dot(v, frame.tangent), dot(v, frame.bitangent), dot(v, frame.normal));
}

/// atan(y, x) to 3·10⁻⁷ rad, without the library's call and without branches: the quotient of the smaller by the larger is
/// brought within ±tan(π/8), where Moshier's (Cephes, atanf) polynomial stands for the arctangent.
SHADING_FN float angle_of(float y, float x) {
    const float ax = abs(x);
    const float ay = abs(y);
    const float smaller = min(ax, ay);
    const float larger = max(max(ax, ay), 1.0e-37f);
    const float beyond = smaller > 0.41421356f * larger ? 1.0f : 0.0f;
    const float t = (smaller - beyond * larger) / (larger + beyond * smaller);
    const float z = t * t;
    float angle = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z - 3.33329491539e-1f) * z * t + t;
    angle += beyond * (0.25f * pi);
    angle = abs((ay > ax ? 0.5f * pi : 0.0f) - angle);  // mirrored at the diagonal
    angle = abs((x < 0.0f ? pi : 0.0f) - angle);        // and at the y axis
    return y < 0.0f ? -angle : angle;
}

/// Cosine and sin of an angle of at most π/4 to either side, by their series to 10⁻⁸.
SHADING_FN vec2 cos_sin_of_octant(float angle) {
    const float z = angle * angle;
    return vec2(1.0f - z * (0.5f - z * (4.16666667e-2f - z * (1.38888889e-3f - z * 2.48015873e-5f))),
                angle * (1.0f - z * (1.66666667e-1f - z * (8.33333333e-3f - z * (1.98412698e-4f - z * 2.75573192e-6f)))));
}

/// Uniform on the unit disk, concentric map: Shirley & Chiu 1997.
SHADING_FN vec2 sample_disk(vec2 u) {
    float x = 2.0f * u.x - 1.0f;
    float y = 2.0f * u.y - 1.0f;
    const bool wide = abs(x) > abs(y);
    const float radius = wide ? x : y;
    const float ratio = (wide ? y : x) / (radius != 0.0f ? radius : 1.0f);
    const vec2 along = cos_sin_of_octant(0.25f * pi * ratio) * radius;
    return vec2(wide ? along.x : along.y, wide ? along.y : along.x);
}

/// Density cos θ/π about +z (Malley's method: the disk projected up).
SHADING_FN vec3 sample_cosine_hemisphere(vec2 u) {
    vec2 d = sample_disk(u);
    return vec3(d.x, d.y, sqrt(max(0.0f, 1.0f - d.x * d.x - d.y * d.y)));
}
SHADING_FN float cosine_hemisphere_pdf(float cos_theta) {
    return max(cos_theta, 0.0f) * inverse_pi;
}

/// Density 1/(2π) about +z.
SHADING_FN vec3 sample_uniform_hemisphere(vec2 u) {
    float z = 1.0f - u.x;
    float r = sqrt(max(0.0f, u.x * (2.0f - u.x)));
    return vec3(r * cos(2.0f * pi * u.y), r * sin(2.0f * pi * u.y), z);
}
SHADING_CONST float uniform_hemisphere_pdf = 0.159154943091895f;

/// Density 1/(4π).
SHADING_FN vec3 sample_uniform_sphere(vec2 u) {
    float z = 1.0f - 2.0f * u.x;
    float r = 2.0f * sqrt(max(0.0f, u.x * (1.0f - u.x)));
    return vec3(r * cos(2.0f * pi * u.y), r * sin(2.0f * pi * u.y), z);
}
SHADING_CONST float uniform_sphere_pdf = 0.0795774715459477f;

/// Uniform in the cone about +z. `one_minus_cos` = 1 − cos of its half-angle, passed so because small
/// cones (the sun) would lose all digits of the cosine.
SHADING_FN vec3 sample_cone(vec2 u, float one_minus_cos) {
    float t = u.x * one_minus_cos;  // 1 − z
    float r = sqrt(max(0.0f, t * (2.0f - t)));
    return vec3(r * cos(2.0f * pi * u.y), r * sin(2.0f * pi * u.y), 1.0f - t);
}
SHADING_FN float cone_pdf(float one_minus_cos) {
    return 1.0f / (2.0f * pi * one_minus_cos);
}

/// Barycentric weights of a uniform point of a triangle: Heitz 2019, "A Low-Distortion Map Between
/// Triangle and Square".
SHADING_FN vec3 sample_triangle(vec2 u) {
    float b0 = u.x < u.y ? 0.5f * u.x : u.x - 0.5f * u.y;
    float b1 = u.x < u.y ? u.y - 0.5f * u.x : 0.5f * u.y;
    return vec3(b0, b1, 1.0f - b0 - b1);
}

/// Weight of the strategy with density `pdf` against one other: Veach & Guibas 1995, the power
/// heuristic with exponent 2. Written as a ratio so that large densities do not overflow.
SHADING_FN float power_heuristic(float pdf, float other_pdf) {
    if (pdf <= 0.0f) {
        return 0.0f;
    }
    float ratio = other_pdf / pdf;
    return 1.0f / (1.0f + ratio * ratio);
}

SHADING_FN float max_component(vec3 c) {
    return max(c.x, max(c.y, c.z));
}

SHADING_END
#endif
