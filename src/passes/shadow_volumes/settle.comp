#version 460
#extension GL_GOOGLE_include_directive : require
// Triangles that a part of the map may have missed, because they are small against its texels. Significant ones are
// looked for closer, in the next round. The others, and in the last round these too, go with the texels about them: they
// are taken to be lit unless these all show something nearer to the sun. To take too many changes no shadow, since what
// is hidden casts its own into another's.
#include "passes/shadow_volumes/casters.glsl"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 8) uniform sampler2D map;  // reversed depth
layout(set = 0, binding = 13, std430) buffer States { uint states[]; };
layout(set = 0, binding = 14, std430) buffer Header {
    LitMapHeader header;
    uint wanted[];
};
layout(push_constant) uniform Push { LitMapConstants push; };

// A surface that rises faster than this from texel to texel is nearly on edge.
const float steepest_texels = 4.0f;

/// A corner in the map: texels, and depth.
vec3 place_of(vec3 corner) {
    const vec4 clip = push.world_to_clip * vec4(corner, 1.0f);
    return vec3((clip.xy * vec2(0.5f, -0.5f) + 0.5f) * float(push.size), clip.z);
}

/// Whether none of the texels about a point shows that it is hidden. `slope`: of the triangle's depth, a texel.
bool seems_lit(vec3 point, vec2 slope) {
    const ivec2 first = ivec2(floor(point.xy - 0.5f));
    const float limit = steepest_texels * push.depth_a_texel;
    for (int i = 0; i < 4; ++i) {
        const ivec2 texel = first + ivec2(i & 1, i >> 1);
        if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(push.size)))) continue;
        const float rise = clamp(dot(slope, vec2(texel) + 0.5f - point.xy), -limit, limit);
        if (point.z + rise + push.depth_a_texel >= texelFetch(map, texel, 0).r) return true;
    }
    return false;
}

void look_closer(vec2 low, vec2 high) {
    const float half_size = 0.5f * float(push.size);
    const uvec2 first = uvec2(greaterThanEqual(low, vec2(half_size)));
    const uvec2 last = uvec2(greaterThanEqual(high, vec2(half_size)));
    for (uint y = first.y; y <= last.y; ++y)
        for (uint x = first.x; x <= last.x; ++x) wanted[(push.child_y + y) * push.child_row + push.child_x + x] = 1u;
}

void main() {
    const uint triangle = linear_invocation();
    if (triangle >= push.triangle_count) return;
    const uint state = states[triangle];
    if ((state & caster_lit) != 0u || (state & (caster_toward | caster_away)) == 0u) return;
    const vec3 corners[3] = caster_corners(caster_ranges[caster_of_triangle(triangle, push.range_count)], triangle);
    const vec3 a = place_of(corners[0]);
    const vec3 b = place_of(corners[1]);
    const vec3 c = place_of(corners[2]);
    const vec2 low = min(a.xy, min(b.xy, c.xy));
    const vec2 high = max(a.xy, max(b.xy, c.xy));
    if (any(lessThan(high, vec2(0.0f))) || any(greaterThan(low, vec2(push.size)))) return;

    const vec2 ab = b.xy - a.xy;
    const vec2 ac = c.xy - a.xy;
    const float twice_area = ab.x * ac.y - ab.y * ac.x;
    const float longest = sqrt(max(dot(ab, ab), max(dot(ac, ac), dot(ac - ab, ac - ab))));
    const bool small = 0.5f * abs(twice_area) < lit_map_seen_texels || abs(twice_area) < longest;
    if (!small) return;
    if ((state & caster_significant) != 0u && push.last_round == 0u) {
        look_closer(low, high);
        return;
    }
    vec2 slope = vec2(0.0f);
    if (twice_area != 0.0f) slope = ((b.z - a.z) * vec2(ac.y, -ac.x) + (c.z - a.z) * vec2(-ab.y, ab.x)) / twice_area;
    // The middle, and half way from there to each corner.
    const vec3 middle = (a + b + c) * (1.0f / 3.0f);
    const vec3 points[4] = vec3[4](middle, 0.5f * (middle + a), 0.5f * (middle + b), 0.5f * (middle + c));
    for (uint i = 0u; i < 4u; ++i) {
        if (any(lessThan(points[i].xy, vec2(0.0f))) || any(greaterThan(points[i].xy, vec2(push.size)))) continue;
        if (!seems_lit(points[i], slope)) continue;
        atomicOr(states[triangle], caster_lit);
        return;
    }
}
