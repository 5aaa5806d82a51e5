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

/// Whether what is stored at the texel stands between the receiver and the light. `position`: the receiver's
/// own, in texels.
uint shadow_tap(ShadowViewData view, ReceiverPlane plane, ivec2 texel, vec2 position, int size) {
    // Rows run down from the top, where the second coordinate is +1.
    const vec2 center = ((vec2(texel) + 0.5f) * (2.0f / float(size)) - 1.0f) * vec2(1.0f, -1.0f);
    const ivec3 place = ivec3(clamp(texel, ivec2(0), ivec2(size - 1)) + ivec2(view.corner_x, view.corner_y), int(view.layer));
    const float stored = texelFetch(shadow_maps, place, 0).r;
    const float slope = abs(plane.gradient.x) + abs(plane.gradient.y);
    const float texel_slope = slope * (2.0f / float(size));
    const float rounding = shadow_depth_rounding * (abs(plane.depth) + slope + (view.kind == shadow_kind_orthographic ? 1.0f : 0.0f));
    float expected = plane.depth + dot(plane.gradient, center);
    // A grazing plane can pass behind a perspective view's horizon within the texel: what stands there is
    // compared with half the receiver's own depth at least.
    if (view.kind == shadow_kind_perspective) expected = max(expected, 0.5f * plane.own_depth);
    const float bias = texel_slope * shadow_snap_texels + rounding;
    if (stored < expected - bias) return tap_beyond;
    if (stored <= expected + bias) return tap_lit;

    const vec2 stored_slope = texelFetch(shadow_slopes, place, 0).rg * stored;
    const float at_receiver = stored + dot(stored_slope, position - (vec2(texel) + 0.5f));
    const float stored_bias = (abs(stored_slope.x) + abs(stored_slope.y)) * shadow_snap_texels;
    return at_receiver <= plane.own_depth + stored_bias + rounding ? tap_lit : tap_blocked;
}

// As shadow_filter_nearest, of a receiver that stands off every surface: what lies beyond it is not between it and the light.
const uint shadow_filter_free = 2u;

float shadow_in_view(uint view_index, vec3 point, vec3 normal, uint filter_mode) {
    const ShadowViewData view = shadow_views[view_index];
    const int size = int(view.size);
    const ReceiverPlane plane = receiver_plane(view, point, normal);
    if (any(greaterThan(abs(plane.at), vec2(1.0f)))) return 1.0f;  // outside what the light's map covers
    const vec2 position = (plane.at * vec2(0.5f, -0.5f) + 0.5f) * float(size);
    const bool nearest = filter_mode != shadow_filter_percentage_closer;
    // Percentage-closer filtering (Reeves, Salesin & Cook 1987) over the four nearest texels, the nearest
    // first, or that one alone. Texels that look past the edge of the receiver's surface have no say: through
    // them light would leak along the seams of walls.
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
        lit += tap == tap_blocked ? 0.0f : weight;
        if (nearest) break;
    }
    return known > 0.0f ? lit / known : 1.0f;
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
    return shadow_in_view(view, point, normal, filter_mode);
}

#endif
