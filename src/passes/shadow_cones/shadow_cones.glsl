// Shadows by cones of a light's true size through the voxel volume.
#ifndef HELIODON_SHADOW_CONES_GLSL
#define HELIODON_SHADOW_CONES_GLSL
#include "passes/common/scene_tables.glsl"
#include "passes/cone_trace/volume.glsl"
#include "shading/cone.h"

/// Share of a light with a cone_radius that reaches a point on a surface of this geometric normal.
float cone_shadow(LightData light, vec3 point, vec3 normal) {
    const bool directional = light.type == light_type_directional;
    const vec3 to_light = directional ? -light.axis : light.position - point;
    const float distance = length(to_light);
    LightData whole = light;
    whole.radius = light.cone_radius;
    const float reach = directional ? 1.0e30f : max(distance - light.cone_radius, 0.0f) / volume.voxel_m;
    return 1.0f - trace_cone(cone_origin(point, normal), to_light / distance, light_cone_tan(whole, point), reach).cover;
}

// Where a batch has at most so many lights their cones are traced ahead of what is lit, for pixels and for voxels, by passes
// that do nothing else: a long walk by little code is faster than by much (docs/performance.md).
const uint most_lights_traced = 4u;
/// The shares of these as two words; halves tell them to a thousandth and better.
uvec2 pack_shares(vec4 shares) { return uvec2(packHalf2x16(shares.xy), packHalf2x16(shares.zw)); }
vec4 unpack_shares(uvec2 words) { return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y)); }

#endif
