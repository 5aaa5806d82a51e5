// The luminous openings of luminaires: boxes (a rectangle where one side is 0), elliptic cylinders (a disc where the
// height is 0) and ellipsoids, centred at the origin. An opening's radiance towards ω is I(ω) / A(ω), A the area of its
// outline seen from there, so that its far intensity is I(ω) exactly. Points from outside alone: within, nothing shines.
#ifndef HELIODON_SHADING_LUMINAIRE_SHAPE_H
#define HELIODON_SHADING_LUMINAIRE_SHAPE_H
#include "shading/light.h"
SHADING_BEGIN

struct OpeningHit {
    float t;      // metres along the unit direction; negative: missed
    vec3 normal;  // unit, outward
};

struct OpeningSample {
    vec3 direction;  // unit, from the receiver
    float t;         // metres
    float pdf;       // per steradian; 0: nothing to be seen
};

/// Cylinders along x or y, turned so that their axis is z; and back.
SHADING_FN vec3 opening_turn(uint shape, vec3 v) {
    if (shape == opening_cylinder_x) {
        return vec3(v.y, v.z, v.x);
    }
    return shape == opening_cylinder_y ? vec3(v.z, v.x, v.y) : v;
}
SHADING_FN vec3 opening_turn_back(uint shape, vec3 v) {
    if (shape == opening_cylinder_x) {
        return vec3(v.z, v.x, v.y);
    }
    return shape == opening_cylinder_y ? vec3(v.y, v.z, v.x) : v;
}
SHADING_FN bool opening_is_cylinder(uint shape) {
    return shape >= opening_cylinder_x && shape <= opening_cylinder_z;
}
/// No volume: each of its points is seen from both sides.
SHADING_FN bool opening_is_flat(vec3 half_extent) {
    return half_extent.x <= 0.0f || half_extent.y <= 0.0f || half_extent.z <= 0.0f;
}

/// Area in m² of the outline towards the unit direction `d`. Of an ellipsoid: Vickers 1996, "The projected areas of
/// ellipsoids and cylinders", Powder Technology 86, eq. 4.
SHADING_FN float opening_projected_area(uint shape, vec3 half_extent, vec3 d) {
    const vec3 h = opening_turn(shape, half_extent);
    const vec3 w = abs(opening_turn(shape, d));
    if (shape == opening_box) {
        return 4.0f * (w.x * h.y * h.z + w.y * h.x * h.z + w.z * h.x * h.y);
    }
    if (opening_is_cylinder(shape)) {
        return pi * h.x * h.y * w.z + 4.0f * h.z * length(vec2(h.x * w.y, h.y * w.x));
    }
    return pi * length(vec3(h.y * h.z * w.x, h.x * h.z * w.y, h.x * h.y * w.z));
}

// -- rays

SHADING_FN float opening_safe(float d) {
    return abs(d) < 1.0e-20f ? 1.0e-20f : d;
}
/// Entry and exit of the slab |p + t d| ≤ h.
SHADING_FN vec2 opening_slab(float p, float d, float h) {
    const float a = (-h - p) / opening_safe(d);
    const float b = (h - p) / opening_safe(d);
    return vec2(min(a, b), max(a, b));
}

SHADING_FN OpeningHit opening_box_hit(vec3 h, vec3 p, vec3 d) {
    const vec2 x = opening_slab(p.x, d.x, h.x);
    const vec2 y = opening_slab(p.y, d.y, h.y);
    const vec2 z = opening_slab(p.z, d.z, h.z);
    OpeningHit hit;
    hit.t = max(x.x, max(y.x, z.x));
    hit.normal = hit.t == x.x ? vec3(-sign(d.x), 0.0f, 0.0f) : hit.t == y.x ? vec3(0.0f, -sign(d.y), 0.0f) : vec3(0.0f, 0.0f, -sign(d.z));
    if (hit.t <= 0.0f || hit.t > min(x.y, min(y.y, z.y))) {
        hit.t = -1.0f;
    }
    return hit;
}

SHADING_FN OpeningHit opening_cylinder_hit(vec3 h, vec3 p, vec3 d) {
    const vec2 q = vec2(p.x / h.x, p.y / h.y);  // the side is the unit circle
    const vec2 e = vec2(d.x / h.x, d.y / h.y);
    const float a = max(dot(e, e), 1.0e-30f);
    const float aside = q.x * e.y - q.y * e.x;
    const float inside = a - aside * aside;
    const vec2 z = opening_slab(p.z, d.z, h.z);
    OpeningHit hit;
    hit.t = -1.0f;
    hit.normal = vec3(0.0f, 0.0f, -sign(d.z));
    if (inside < 0.0f) {
        return hit;
    }
    const float middle = -dot(q, e) / a;
    const float half_chord = sqrt(inside) / a;
    const float t = max(middle - half_chord, z.x);
    if (t <= 0.0f || t > min(middle + half_chord, z.y)) {
        return hit;
    }
    hit.t = t;
    if (t > z.x) {
        hit.normal = normalize(vec3((q.x + t * e.x) / h.x, (q.y + t * e.y) / h.y, 0.0f));
    }
    return hit;
}

SHADING_FN OpeningHit opening_ellipsoid_hit(vec3 h, vec3 p, vec3 d) {
    const vec3 q = p / h;  // the unit sphere
    const vec3 e = d / h;
    const float a = dot(e, e);
    const float middle = -dot(q, e) / a;
    const vec3 aside = q + e * middle;
    const float inside = 1.0f - dot(aside, aside);
    OpeningHit hit;
    hit.t = -1.0f;
    hit.normal = vec3(0.0f, 0.0f, 1.0f);
    if (inside < 0.0f || middle <= 0.0f || dot(q, q) <= 1.0f) {
        return hit;
    }
    hit.t = middle - sqrt(inside / a);
    hit.normal = normalize((q + e * hit.t) / h);
    return hit;
}

/// Where the ray from `p` along the unit direction `d` enters the opening.
SHADING_FN OpeningHit opening_intersect(uint shape, vec3 half_extent, vec3 p, vec3 d) {
    const vec3 h = opening_turn(shape, half_extent);
    const vec3 from = opening_turn(shape, p);
    const vec3 along = opening_turn(shape, d);
    OpeningHit hit;
    if (shape == opening_box) {
        hit = opening_box_hit(h, from, along);
    } else if (opening_is_cylinder(shape)) {
        hit = opening_cylinder_hit(h, from, along);
    } else {
        hit = opening_ellipsoid_hit(h, from, along);
    }
    hit.normal = opening_turn_back(shape, hit.normal);
    return hit;
}

// -- the part that a receiver sees. Flat faces are picked by area times distance from their plane, which is what they
// send there when far away; their density t²/(cos · area) · chance is then t³ over the sum of these.

/// Half the visible arc of a cylinder's side, in the angle of the unit circle that it is scaled to.
SHADING_FN float opening_half_arc(float scaled_distance) {
    return acos(clamp(1.0f / scaled_distance, 0.0f, 1.0f));
}
/// Chances of what is seen from `p`, not normalized: faces across x, y and z of a box; of a cylinder (0, side, cap).
SHADING_FN vec3 opening_face_chances(uint shape, vec3 h, vec3 p) {
    const vec3 beyond = max(abs(p) - h, vec3(0.0f));
    if (shape == opening_box) {
        return 4.0f * vec3(h.y * h.z, h.x * h.z, h.x * h.y) * beyond;
    }
    const float scaled = length(vec2(p.x / h.x, p.y / h.y));
    const float mean_radius = sqrt(0.5f * (h.x * h.x + h.y * h.y));
    const float side = scaled > 1.0f ? 4.0f * h.z * opening_half_arc(scaled) * mean_radius * (scaled - 1.0f) * mean_radius : 0.0f;
    return vec3(0.0f, side, pi * h.x * h.y * beyond.z);
}
SHADING_FN float opening_side_density(vec3 h, vec3 p, vec3 along, float t, vec3 normal, float chance) {
    const vec2 on = vec2((p.x + along.x * t) / h.x, (p.y + along.y * t) / h.y);
    const float arc_speed = length(vec2(h.x * on.y, h.y * on.x));  // metres of arc a radian of the unit circle
    const float half_arc = opening_half_arc(length(vec2(p.x / h.x, p.y / h.y)));
    const float area_density = chance / max(4.0f * half_arc * h.z * arc_speed, 1.0e-30f);
    return t * t * area_density / max(abs(dot(normal, along)), 1.0e-12f);
}
/// By the cone in which the unit sphere appears where the ellipsoid is scaled to it; dω' = dω / (det S |S⁻¹ω|³).
SHADING_FN float opening_ellipsoid_density(vec3 h, vec3 p, vec3 along) {
    const vec3 q = p / h;
    const float stretch = length(along / h);
    return cone_pdf(one_minus_cos_from_sin2(1.0f / dot(q, q))) / (h.x * h.y * h.z * stretch * stretch * stretch);
}

/// Density per steradian with which opening_sample, from `p`, picks the direction `d` that met `hit`.
SHADING_FN float opening_pdf(uint shape, vec3 half_extent, vec3 p, vec3 d, OpeningHit hit) {
    const vec3 h = opening_turn(shape, half_extent);
    const vec3 from = opening_turn(shape, p);
    const vec3 along = opening_turn(shape, d);
    if (hit.t <= 0.0f) {
        return 0.0f;
    }
    if (shape == opening_ellipsoid) {
        return opening_ellipsoid_density(h, from, along);
    }
    const vec3 chances = opening_face_chances(shape, h, from);
    const float sum = chances.x + chances.y + chances.z;
    const vec3 normal = opening_turn(shape, hit.normal);
    if (sum <= 0.0f) {
        return 0.0f;
    }
    if (shape != opening_box && normal.z == 0.0f) {
        return opening_side_density(h, from, along, hit.t, normal, chances.y / sum);
    }
    return hit.t * hit.t * hit.t / sum;
}

/// A point of the box or the cylinder that `from` sees, and 1 on a cylinder's side, else 0; `u` picks the face first.
SHADING_FN vec4 opening_visible_point(uint shape, vec3 h, vec3 from, vec3 chances, vec2 u) {
    const float pick = u.x * (chances.x + chances.y + chances.z);
    const vec3 near = vec3(from.x < 0.0f ? -h.x : h.x, from.y < 0.0f ? -h.y : h.y, from.z < 0.0f ? -h.z : h.z);
    const float across = 2.0f * u.y - 1.0f;
    if (pick < chances.x) {
        return vec4(near.x, h.y * (2.0f * pick / chances.x - 1.0f), h.z * across, 0.0f);
    }
    if (pick < chances.x + chances.y) {
        const float along = 2.0f * (pick - chances.x) / chances.y - 1.0f;
        if (shape == opening_box) {
            return vec4(h.x * along, near.y, h.z * across, 0.0f);
        }
        const vec2 q = vec2(from.x / h.x, from.y / h.y);
        const float angle = atan(q.y, q.x) + opening_half_arc(length(q)) * along;
        return vec4(h.x * cos(angle), h.y * sin(angle), h.z * across, 1.0f);
    }
    const float v = clamp((pick - chances.x - chances.y) / chances.z, 0.0f, 1.0f);
    const vec2 disk = sample_disk(vec2(v, u.y));
    return shape == opening_box ? vec4(h.x * (2.0f * v - 1.0f), h.y * across, near.z, 0.0f)
                                : vec4(h.x * disk.x, h.y * disk.y, near.z, 0.0f);
}

SHADING_FN OpeningSample opening_ellipsoid_sample(vec3 h, vec3 from, vec2 u) {
    const vec3 q = from / h;
    const float squared = dot(q, q);
    OpeningSample result;
    result.direction = vec3(0.0f, 0.0f, 1.0f);
    result.t = 0.0f;
    result.pdf = 0.0f;
    if (squared > 1.0f) {
        const vec3 local = sample_cone(u, one_minus_cos_from_sin2(1.0f / squared));
        result.direction = normalize(to_world(frame_from_normal(q * (-inversesqrt(squared))), local) * h);
        const OpeningHit hit = opening_ellipsoid_hit(h, from, result.direction);
        // What rounding puts past the edge is the edge.
        const vec3 e = result.direction / h;
        result.t = hit.t > 0.0f ? hit.t : -dot(q, e) / dot(e, e);
        result.pdf = opening_ellipsoid_density(h, from, result.direction);
    }
    return result;
}

/// A direction from `p` to a point of the opening that is seen from there.
SHADING_FN OpeningSample opening_sample(uint shape, vec3 half_extent, vec3 p, vec2 u) {
    const vec3 h = opening_turn(shape, half_extent);
    const vec3 from = opening_turn(shape, p);
    if (shape == opening_ellipsoid) {
        return opening_ellipsoid_sample(h, from, u);
    }
    OpeningSample result;
    result.direction = vec3(0.0f, 0.0f, 1.0f);
    result.t = 0.0f;
    result.pdf = 0.0f;
    const vec3 chances = opening_face_chances(shape, h, from);
    const float sum = chances.x + chances.y + chances.z;
    if (sum <= 0.0f) {
        return result;
    }
    const vec4 point = opening_visible_point(shape, h, from, chances, u);
    const vec3 path = vec3(point) - from;
    result.t = length(path);
    const vec3 along = path / max(result.t, 1.0e-30f);
    result.direction = opening_turn_back(shape, along);
    result.pdf = result.t * result.t * result.t / sum;
    if (point.w > 0.0f) {
        const vec3 normal = normalize(vec3(point.x / (h.x * h.x), point.y / (h.y * h.y), 0.0f));
        result.pdf = opening_side_density(h, from, along, result.t, normal, chances.y / sum);
    }
    return result;
}

// -- the whole surface

struct OpeningPoint {
    vec3 position;
    vec3 weighted_normal;  // outward, 1/density in m² long; 0 for flat openings, of which each point shines alike
};

/// How often a face is picked, 0 to 31: bit 5 i of `weights` on. Faces 0 to 5 of a box lie towards +x, −x, +y, −y, +z and
/// −z; of a cylinder, turned, 0 is the side, 4 and 5 are the caps.
SHADING_FN float opening_face_weight(uint weights, uint face) {
    return float((weights >> (5u * face)) & 31u);
}

SHADING_FN OpeningPoint opening_box_point(vec3 h, uint face, float weight, float v, float across) {
    const float side = (face & 1u) == 0u ? 1.0f : -1.0f;
    const float along = 2.0f * v - 1.0f;
    OpeningPoint point;
    if (face < 2u) {
        point.position = vec3(side * h.x, h.y * along, h.z * across);
        point.weighted_normal = vec3(side * 4.0f * h.y * h.z / weight, 0.0f, 0.0f);
    } else if (face < 4u) {
        point.position = vec3(h.x * along, side * h.y, h.z * across);
        point.weighted_normal = vec3(0.0f, side * 4.0f * h.x * h.z / weight, 0.0f);
    } else {
        point.position = vec3(h.x * along, h.y * across, side * h.z);
        point.weighted_normal = vec3(0.0f, 0.0f, side * 4.0f * h.x * h.y / weight);
    }
    return point;
}
SHADING_FN OpeningPoint opening_cylinder_point(vec3 h, uint face, float weight, float v, vec2 u) {
    OpeningPoint point;
    if (face < 4u) {
        const float angle = 2.0f * pi * v;
        point.position = vec3(h.x * cos(angle), h.y * sin(angle), h.z * (2.0f * u.y - 1.0f));
        // The arc's length a radian times its normal is (h.y cos, h.x sin).
        point.weighted_normal = vec3(h.y * cos(angle), h.x * sin(angle), 0.0f) * (4.0f * pi * h.z / weight);
    } else {
        const float side = face == 4u ? 1.0f : -1.0f;
        const vec2 disk = sample_disk(vec2(v, u.y));
        point.position = vec3(h.x * disk.x, h.y * disk.y, side * h.z);
        point.weighted_normal = vec3(0.0f, 0.0f, side * pi * h.x * h.y / weight);
    }
    return point;
}

/// A point of the whole surface. The mean over `u` of f(position) · max(weighted_normal · ω, 0) is the integral of f over
/// the outline towards ω, whichever faces are picked more often.
SHADING_FN OpeningPoint opening_surface_point(uint shape, vec3 half_extent, uint face_weights, vec2 u) {
    const vec3 h = opening_turn(shape, half_extent);
    OpeningPoint point;
    if (shape == opening_ellipsoid) {
        const vec3 unit = sample_uniform_sphere(u);
        point.position = h * unit;
        point.weighted_normal = 4.0f * pi * h.x * h.y * h.z * unit / h;
        return point;
    }
    float total = 0.0f;
    for (uint i = 0u; i < 6u; ++i) {
        total += opening_face_weight(face_weights, i);
    }
    float left = min(u.x, 0.999999f) * total;
    uint face = 0u;
    while (face < 5u && left >= opening_face_weight(face_weights, face)) {
        left -= opening_face_weight(face_weights, face);
        ++face;
    }
    const float weight = max(opening_face_weight(face_weights, face), 1.0f);
    const float v = min(left / weight, 1.0f);
    if (shape == opening_box) {
        point = opening_box_point(h, face, weight / total, v, 2.0f * u.y - 1.0f);
    } else {
        point = opening_cylinder_point(h, face, weight / total, v, u);
    }
    if (opening_is_flat(half_extent)) {
        point.weighted_normal = vec3(0.0f);
    }
    point.position = opening_turn_back(shape, point.position);
    point.weighted_normal = opening_turn_back(shape, point.weighted_normal);
    return point;
}

SHADING_END
#endif
