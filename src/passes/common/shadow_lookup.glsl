// Does a light reach a point? Every tap compares the stored depth with the depth of the receiver's own
// plane at that tap (receiver-plane depth: Isidoro 2006, "Shadow Mapping: GPU-based Tips and Techniques"),
// so a lit plane never shadows itself at any slope or scale and the only bias left is what rasterization
// itself rounds. What stands nearer there blocks the light only if the plane of its triangle, which the map
// keeps, is also nearer where the receiver's own ray passes: in folds and corners, where the neighbouring
// surface rises towards the light, it is not.
#ifndef HELIODON_SHADOW_LOOKUP_GLSL
#define HELIODON_SHADOW_LOOKUP_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "passes/common/scene_tables.glsl"
#include "shading/light.h"

layout(set = 0, binding = 9, std430) readonly buffer ShadowViews { ShadowViewData shadow_views[]; };
layout(set = 0, binding = 10) uniform sampler2DArray shadow_maps;
layout(set = 0, binding = 15) uniform sampler2DArray shadow_slopes;

// Vertices snap to 1/256 texel (VkPhysicalDeviceLimits::subPixelPrecisionBits is 8 or more) before a
// triangle's depth is set up; twice that covers both ends of an edge.
const float shadow_snap_texels = 2.0f / 256.0f;
// Depth is a plane equation in 32-bit floats: a few rounding errors of its terms.
const float shadow_depth_rounding = 1.0f / 1048576.0f;

/// A stored depth as a linear function of the view's normalized device coordinates.
struct ReceiverPlane {
    float depth;  // at (0, 0)
    vec2 gradient;
    vec2 at;      // the receiver's own coordinates
    float own_depth;
};

ReceiverPlane receiver_plane(ShadowViewData view, vec3 point, vec3 normal) {
    ReceiverPlane plane;
    const vec3 offset = point - view.origin;
    const vec4 clip = view.world_to_clip * vec4(point, 1.0f);
    plane.at = clip.xy / clip.w;
    plane.own_depth = clip.z / clip.w;
    if (view.kind == shadow_kind_perspective) {
        // 1/w along the ray forward + u axis_u + v axis_v is linear in (u, v).
        const float scale = view.near_m / dot(normal, offset);
        plane.gradient = scale * vec2(dot(normal, view.axis_u), dot(normal, view.axis_v));
    } else {
        const float scale = 1.0f / (view.range_m * dot(normal, view.forward));
        plane.gradient = scale * vec2(dot(normal, view.axis_u), dot(normal, view.axis_v));
    }
    plane.depth = plane.own_depth - dot(plane.gradient, plane.at);
    return plane;
}

const uint tap_lit = 0u;
const uint tap_blocked = 1u;
const uint tap_beyond = 2u;  // the map looks past the receiver's edge there and knows nothing of it

float stored_depth(ShadowViewData view, ivec2 texel, int size) {
    const ivec2 within = clamp(texel, ivec2(0), ivec2(size - 1));
    return texelFetch(shadow_maps, ivec3(within + ivec2(view.corner_x, view.corner_y), int(view.layer)), 0).r;
}

float plane_slope(ReceiverPlane plane) { return abs(plane.gradient.x) + abs(plane.gradient.y); }
float depth_rounding(ShadowViewData view, ReceiverPlane plane) {
    return shadow_depth_rounding * (abs(plane.depth) + plane_slope(plane) + (view.kind == shadow_kind_orthographic ? 1.0f : 0.0f));
}

/// What is stored at the texel against the receiver's plane there; blocked: it is nearer to the light.
uint plane_tap(ShadowViewData view, ReceiverPlane plane, float stored, ivec2 texel, int size) {
    // Rows run down from the top, where the second coordinate is +1.
    const vec2 center = ((vec2(texel) + 0.5f) * (2.0f / float(size)) - 1.0f) * vec2(1.0f, -1.0f);
    float expected = plane.depth + dot(plane.gradient, center);
    // A grazing plane can pass behind a perspective view's horizon within the texel: what stands there is
    // compared with half the receiver's own depth at least.
    if (view.kind == shadow_kind_perspective) expected = max(expected, 0.5f * plane.own_depth);
    const float bias = plane_slope(plane) * (2.0f / float(size)) * shadow_snap_texels + depth_rounding(view, plane);
    if (stored < expected - bias) return tap_beyond;
    return stored <= expected + bias ? tap_lit : tap_blocked;
}

/// Whether what is stored at the texel stands between the receiver and the light. `position`: the receiver's
/// own, in texels.
uint shadow_tap(ShadowViewData view, ReceiverPlane plane, ivec2 texel, vec2 position, int size) {
    const float stored = stored_depth(view, texel, size);
    const uint tap = plane_tap(view, plane, stored, texel, size);
    if (tap != tap_blocked) return tap;
    const ivec3 place = ivec3(clamp(texel, ivec2(0), ivec2(size - 1)) + ivec2(view.corner_x, view.corner_y), int(view.layer));
    const vec2 stored_slope = texelFetch(shadow_slopes, place, 0).rg * stored;
    const float at_receiver = stored + dot(stored_slope, position - (vec2(texel) + 0.5f));
    const float stored_bias = (abs(stored_slope.x) + abs(stored_slope.y)) * shadow_snap_texels;
    return at_receiver <= plane.own_depth + stored_bias + depth_rounding(view, plane) ? tap_lit : tap_blocked;
}

/// In metres along the light from the receiver to what is stored at the texel of a directional light's map.
float blocker_distance(ShadowViewData view, ReceiverPlane plane, ivec2 texel, int size) {
    return (stored_depth(view, texel, size) - plane.own_depth) * view.range_m;
}

// As shadow_filter_nearest, of a receiver that stands off every surface: what lies beyond it is not between it and the light.
const uint shadow_filter_free = 2u;
// As shadow_filter_contact_hardening, of the sun, whose disc is darker towards its limb.
const uint shadow_filter_sun = 4u;

/// Percentage-closer filtering (Reeves, Salesin & Cook 1987) over the four nearest texels, the nearest
/// first, or that one alone. Texels that look past the edge of the receiver's surface have no say: through
/// them light would leak along the seams of walls. What stands `far_m` before the receiver or more is left out.
float filtered_by_texels(ShadowViewData view, ReceiverPlane plane, vec2 position, int size, uint filter_mode, float far_m) {
    const bool nearest = filter_mode == shadow_filter_nearest || filter_mode == shadow_filter_free;
    const ivec2 texel = ivec2(floor(position));
    const vec2 offset = position - vec2(texel) - 0.5f;
    const ivec2 side = ivec2(offset.x < 0.0f ? -1 : 1, offset.y < 0.0f ? -1 : 1);
    float lit = 0.0f;
    float known = 0.0f;
    [[dont_unroll]] for (int i = 0; i < 4; ++i) {
        const ivec2 corner = ivec2(i & 1, i >> 1);
        const vec2 share = mix(1.0f - abs(offset), abs(offset), vec2(corner));
        const uint tap = shadow_tap(view, plane, texel + corner * side, position, size);
        if (tap == tap_beyond && filter_mode != shadow_filter_free) continue;
        const float weight = nearest ? 1.0f : share.x * share.y;
        known += weight;
        const bool blocked = tap == tap_blocked && (far_m <= 0.0f || blocker_distance(view, plane, texel + corner * side, size) < far_m);
        lit += blocked ? 0.0f : weight;
        if (nearest) break;
    }
    return known > 0.0f ? lit / known : 1.0f;
}

// Taps that look for what stands in the way, and that find its share of the light's disc.
const int search_taps = 16;
const int disc_taps = 32;

/// One of several points evenly over the solid angle of a light's disc.
struct DiscPoint {
    vec2 at;        // across the light, where the disc's edge is 1 away
    float radius;   // there, of the disc of its share
    float sine2;    // of its angle to the middle, where the edge's is 1
};

/// From the middle outwards (Vogel 1979, "A better way to construct the sunflower head"). `tangent`: of the angular radius.
DiscPoint disc_point(int index, int count, float tangent) {
    const float golden_angle = 2.3999632f;
    const float angle = float(index) * golden_angle;
    const float share = (float(index) + 0.5f) / float(count);
    const float secant = sqrt(1.0f + tangent * tangent);
    const float scale = 1.0f / (secant * (secant + 1.0f));  // (1 − cos) / tan², exact for small discs too
    const float whole = tangent * tangent * scale;          // 1 − cos of the angular radius
    const float cosine = 1.0f - share * whole;
    DiscPoint point;
    point.at = sqrt(share * scale * (1.0f + cosine)) / cosine * vec2(cos(angle), sin(angle));
    // A plane across the light holds 1 / cos³ as much area for a solid angle.
    point.radius = sqrt(2.0f * scale / (float(count) * cosine)) / cosine;
    point.sine2 = share * (1.0f + cosine) / (2.0f - whole);
    return point;
}

/// What a lookup about a receiver knows of the disc of a directional light.
struct Penumbra {
    vec2 texels_a_metre;  // across the light
    float texel_m;
    float far_m;  // from where on a penumbra is wider than texels
    int size;
};

/// What stands before the receiver `offset` metres beside it, in metres along the light: 0 where nothing does, or nothing so
/// far off that the map shows its penumbra; below 0 outside the map. Outside the cone to the disc it stands before the receiver's plane.
float far_blocker(ShadowViewData view, ReceiverPlane plane, vec2 position, Penumbra penumbra, vec2 offset) {
    // The cone to a wide disc leaves the map by more texels than an integer counts.
    const vec2 place = clamp(position + offset * penumbra.texels_a_metre, vec2(-1.0f), vec2(penumbra.size));
    const ivec2 texel = ivec2(floor(place));
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(penumbra.size)))) return -1.0f;
    const float distance_m = blocker_distance(view, plane, texel, penumbra.size);
    if (distance_m < penumbra.far_m) return 0.0f;
    if (length(offset) <= distance_m * view.disc_tangent) return distance_m;
    return plane_tap(view, plane, stored_depth(view, texel, penumbra.size), texel, penumbra.size) == tap_blocked ? distance_m : 0.0f;
}

/// The mean of what stands within `radius` metres beside the receiver; 0: nothing. `umbra`: all of it hides the disc.
float mean_blocker(ShadowViewData view, ReceiverPlane plane, vec2 position, Penumbra penumbra, float radius, out bool umbra) {
    float sum = 0.0f;
    float blockers = 0.0f;
    bool all_hide = true;
    [[dont_unroll]] for (int i = 0; i < search_taps; ++i) {
        const DiscPoint point = disc_point(i, search_taps, view.disc_tangent);
        const vec2 offset = point.at * radius;
        const float distance_m = far_blocker(view, plane, position, penumbra, offset);
        if (distance_m < 0.0f) continue;
        const float nearest = length(offset) - point.radius * radius;
        all_hide = all_hide && distance_m > 0.0f && nearest <= distance_m * view.disc_tangent;
        if (distance_m == 0.0f) continue;
        sum += distance_m;
        blockers += 1.0f;
    }
    umbra = all_hide && blockers > 0.0f;
    return blockers > 0.0f ? sum / blockers : 0.0f;
}

/// Does what stands in the way keep back a ray to the point `toward` of the light's unit disc? The map is looked at where the
/// ray is as far off as the mean blocker; if something nearer stands there, which the ray passes farther in, there as well.
uint ray_tap(ShadowViewData view, ReceiverPlane plane, vec2 position, Penumbra penumbra, vec2 toward, float radius) {
    float at = radius;
    for (int i = 0; i < 2; ++i) {
        const float distance_m = far_blocker(view, plane, position, penumbra, toward * at);
        if (distance_m <= 0.0f) return distance_m == 0.0f ? tap_lit : tap_beyond;
        const float own = distance_m * view.disc_tangent;
        if ((at - own) * length(toward) <= 0.5f * penumbra.texel_m) return tap_blocked;
        at = own;
    }
    return tap_lit;
}

/// Share of the light's disc that the receiver sees: a penumbra as wide as the disc looks from what stands in the way
/// (Fernando 2005, "Percentage-Closer Soft Shadows"; a disc at infinity makes it distance · 2 tan of its angular radius).
/// What stands so near that its penumbra is no wider than texels is filtered by them, and taken to hide its share of what
/// the far leaves. A setting sun is taken as its whole disc about the middle of what is above the horizon.
float contact_hardened(ShadowViewData view, ReceiverPlane plane, vec2 position, int size, bool sun) {
    Penumbra penumbra;
    penumbra.texels_a_metre = 0.5f * float(size) / vec2(length(view.axis_u), length(view.axis_v));
    penumbra.texel_m = 1.0f / max(penumbra.texels_a_metre.x, penumbra.texels_a_metre.y);
    penumbra.far_m = penumbra.texel_m / view.disc_tangent;
    penumbra.size = size;
    const float near = filtered_by_texels(view, plane, position, size, shadow_filter_percentage_closer, penumbra.far_m);
    // As near to the light as anything stands; then as what is found there, and again in the disc that that is seen through.
    float distance_m = (1.0f - plane.own_depth) * view.range_m;
    for (int search = 0; search < 2; ++search) {
        if (near == 0.0f || distance_m < penumbra.far_m) return near;
        bool umbra;
        const float found_m = mean_blocker(view, plane, position, penumbra, distance_m * view.disc_tangent, umbra);
        if (umbra) return 0.0f;
        if (found_m > 0.0f || search == 0) distance_m = found_m;
    }
    if (distance_m == 0.0f) return near;
    float lit = 0.0f;
    float known = 0.0f;
    [[dont_unroll]] for (int i = 0; i < disc_taps; ++i) {
        const DiscPoint point = disc_point(i, disc_taps, view.disc_tangent);
        const uint tap = ray_tap(view, plane, position, penumbra, point.at, distance_m * view.disc_tangent);
        if (tap == tap_beyond) continue;  // the map
        const float weight = sun ? limb_darkening(point.sine2) : 1.0f;
        known += weight;
        lit += tap == tap_blocked ? 0.0f : weight;
    }
    return known > 0.0f ? near * lit / known : near;
}

float shadow_in_view(ShadowViewData view, ReceiverPlane plane, uint filter_mode) {
    const int size = int(view.size);
    const vec2 position = (plane.at * vec2(0.5f, -0.5f) + 0.5f) * float(size);
    const bool sun = filter_mode == shadow_filter_sun;
    if ((sun || filter_mode == shadow_filter_contact_hardening) && view.disc_tangent > 0.0f)
        return contact_hardened(view, plane, position, size, sun);
    return filtered_by_texels(view, plane, position, size, filter_mode, 0.0f);
}

/// A point's share of the say of a view: all of it within, less over the border of a cascade, none outside.
float view_share(ShadowViewData view, vec2 at) {
    const float inside = 1.0f - max(abs(at.x), abs(at.y));
    if (inside < 0.0f) return 0.0f;
    return view.border > 0.0f ? min(inside / view.border, 1.0f) : 1.0f;
}

/// By the narrowest view that the point lies in and, in its border, by the next as well. Outside what the light's maps
/// cover nothing blocks it.
float shadow_in_views(uint first, vec3 point, vec3 normal, uint filter_mode) {
    float lit = 0.0f;
    float rest = 1.0f;
    for (uint index = first; rest > 0.0f; ++index) {
        const ShadowViewData view = shadow_views[index];
        if (view.kind != shadow_kind_none) {
            const ReceiverPlane plane = receiver_plane(view, point, normal);
            const float share = view_share(view, plane.at);
            if (share > 0.0f) lit += rest * share * shadow_in_view(view, plane, filter_mode);
            rest *= 1.0f - share;
        }
        if (view.wider == 0u) break;
    }
    return lit + rest;
}

/// Face of a cube of views: +X −X +Y −Y +Z −Z, by the major axis.
uint cube_face(vec3 direction) {
    const vec3 size = abs(direction);
    if (size.x >= size.y && size.x >= size.z) return direction.x >= 0.0f ? 0u : 1u;
    if (size.y >= size.z) return direction.y >= 0.0f ? 2u : 3u;
    return direction.z >= 0.0f ? 4u : 5u;
}

/// Share of `light` that reaches `point` on a surface of geometric normal `normal`.
float light_visibility(LightData light, vec3 point, vec3 normal, uint filter_mode) {
    if (light.shadow == no_texture) return 1.0f;
    uint view = light.shadow & 0x7fffffffu;
    const bool cube = (light.shadow & 0x80000000u) != 0u;
    if (cube) view += cube_face(point - light.position);
    const bool sun = filter_mode == shadow_filter_contact_hardening && light.opening == opening_sun;
    return shadow_in_views(view, point, normal, sun ? shadow_filter_sun : filter_mode);
}

#endif
