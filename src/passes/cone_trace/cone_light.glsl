// Light that cones bring: from the volume and, past it, from the sky.
#ifndef HELIODON_CONE_LIGHT_GLSL
#define HELIODON_CONE_LIGHT_GLSL
#include "passes/common/sky_lookup.glsl"
#include "passes/cone_trace/volume.glsl"
#include "shading/cone.h"

const float unlimited = 1.0e30f;

/// The sky over a cone of `one_minus_cos`: its solid angle / 2π.
vec3 sky_over_cone(vec3 direction, float one_minus_cos) {
    vec3 texel = vec3(1.0f);
    if (sky_image_slot != no_texture) {
        const vec2 size = vec2(textureSize(textures[nonuniformEXT(sky_image_slot)], 0));
        const float texel_angle = 2.0f * pi * pi / (size.x * size.y);  // at the horizon of an equirectangular map
        texel = sky_map(sky_image_slot, direction, max(0.0f, 0.5f * log2(2.0f * pi * one_minus_cos / texel_angle)));
    }
    return sky_radiance_filtered(sky_data, texel);
}

struct ConeLight {
    vec3 radiance;   // cd/m², mean over the cone
    float openness;  // share that nothing in the volume covers
};

/// `origin` in finest voxels, cone.direction in the world.
ConeLight cone_light(vec3 origin, Cone cone) {
    const ConeResult traced = trace_cone(origin, cone.direction, cone.tan_half_angle, unlimited);
    ConeLight light = ConeLight(traced.radiance, 1.0f - traced.cover);
    if (volume.sky_enabled == 0u || sky_data.model == sky_model_none) return light;
    const float seen = (volume.effects & gi_effect_occlusion) != 0u ? light.openness : 1.0f;
    if (seen > 0.0f) light.radiance += seen * sky_over_cone(cone.direction, cone.one_minus_cos);
    return light;
}

/// Irradiance / π (cd/m²) by `sets` sets of nine cones about the normal, and the cosine-weighted openness.
ConeLight diffuse_light(vec3 origin, vec3 normal, uint sets, vec2 shift) {
    const Frame frame = frame_from_normal(normal);
    ConeLight sum = ConeLight(vec3(0.0f), 0.0f);
    for (uint i = 0u; i < sets * cones_per_set; ++i) {
        Cone cone = diffuse_cone(i % cones_per_set, i / cones_per_set, sets, shift, 1.0f);
        cone.direction = to_world(frame, cone.direction);
        const ConeLight light = cone_light(origin, cone);
        sum.radiance += cone.weight * light.radiance;
        sum.openness += cone.weight * light.openness;
    }
    return sum;
}

#endif
