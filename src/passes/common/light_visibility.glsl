// Does a light reach a point? By its shadow map, or by a cone of its true size through the voxel volume.
#ifndef HELIODON_LIGHT_VISIBILITY_GLSL
#define HELIODON_LIGHT_VISIBILITY_GLSL
#include "passes/common/shadow_lookup.glsl"
#include "passes/shadow_cones/shadow_cones.glsl"

layout(constant_id = 7) const bool cone_shadows = false;
layout(constant_id = 17) const bool shadows_traced = false;  // ahead
vec4 traced_shares = vec4(1.0f);  // then what of the batch's lights reaches the point

/// Share of `light`, the batch's light `index`, that reaches `point` on a surface of geometric normal `normal`.
float light_reaching(LightData light, uint index, vec3 point, vec3 normal, uint filter_mode) {
    if (cone_shadows && light.cone_radius > 0.0f) {
        if (shadows_traced) return traced_shares[index];
        return cone_shadow(light, point, normal);
    }
    return light_visibility(light, point, normal, filter_mode);
}

#endif
