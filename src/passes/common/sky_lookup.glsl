// The sky as it is seen, not reflected.
#ifndef HELIODON_SKY_LOOKUP_GLSL
#define HELIODON_SKY_LOOKUP_GLSL
#include "passes/common/scene_tables.glsl"
#include "passes/common/textures.glsl"
#include "shading/sky.h"

vec3 sky_map(uint slot, vec3 direction, float level) {
    return textureLod(textures[nonuniformEXT(slot)], sky_uv(direction, sky_data.north_rad), level).rgb;
}

vec3 sky_seen(vec3 direction) {
    vec3 texel = vec3(1.0f);
    if (sky_data.model == sky_model_image && sky_image_slot != no_texture) texel = sky_map(sky_image_slot, direction, 0.0f);
    return sky_radiance(sky_data, direction, texel);
}

#endif
