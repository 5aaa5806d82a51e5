// Does a light reach a point? By its shadow map, by a cone of its true size through the voxel volume,
// or by the shadow volumes that a pixel stands in.
#ifndef HELIODON_LIGHT_VISIBILITY_GLSL
#define HELIODON_LIGHT_VISIBILITY_GLSL
#include "passes/common/shadow_lookup.glsl"
#include "passes/shadow_cones/shadow_cones.glsl"

layout(constant_id = 7) const bool cone_shadows = false;
layout(constant_id = 17) const bool shadows_traced = false;  // ahead
vec4 traced_shares = vec4(1.0f);  // then what of the batch's lights reaches the point
layout(constant_id = 20) const bool volumes_cast = false;  // one light's shadows, in a pixel
uint volume_light = no_light;  // then that light of the batch
float volume_share = 1.0f;     // and what of it reaches the point
layout(constant_id = 21) const bool maps_follow = false;  // some of what is in its way casts no volume

/// Share of `light`, the batch's light `index`, that reaches `point` on a surface of geometric normal `normal`.
float light_reaching(LightData light, uint index, vec3 point, vec3 normal, uint filter_mode) {
    if (volumes_cast && index == volume_light) {
        if (!maps_follow || volume_share == 0.0f) return volume_share;
        return light_visibility(light, point, normal, filter_mode);
    }
    if (cone_shadows && light.cone_radius > 0.0f) {
        if (shadows_traced) return traced_shares[index];
        return cone_shadow(light, point, normal);
    }
    return light_visibility(light, point, normal, filter_mode);
}

#endif
