// What surfaces get of the open sky, and of surroundings that reflect light though none is traced (shading/ambient.h).
#ifndef HELIODON_SKY_LIGHT_GLSL
#define HELIODON_SKY_LIGHT_GLSL
#include "passes/common/sky_lookup.glsl"
#include "shading/ambient.h"
#include "shading/environment.h"

bool sky_shines(uint enabled) { return has_sky && enabled != 0u && sky_data.model != sky_model_none; }

/// Irradiance / π on a plane of this normal under the open sky.
vec3 sky_diffuse(vec3 normal) {
    vec3 texel = vec3(1.0f);
    if (sky_irradiance_slot != no_texture) texel = sky_map(sky_irradiance_slot, normal, 0.0f);
    return sky_radiance_filtered(sky_data, texel);
}

vec3 sky_specular(vec3 normal, vec3 wo, float roughness) {
    vec3 texel = vec3(1.0f);
    if (sky_specular_slot != no_texture) {
        const vec3 mirror = reflect(-wo, normal);
        texel = sky_map(sky_specular_slot, dominant_reflection(normal, mirror, roughness), roughness * float(sky_specular_levels - 1u));
    }
    return sky_radiance_filtered(sky_data, texel);
}

/// Irradiance / π on a plane of this normal from what surroundings reflect.
vec3 ambient_diffuse(vec3 normal, bool sky) {
    const bool directional = ambient_data.kind == ambient_directional;
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < ambient_data.light_count; ++i)
        sum += ambient_lights[i].illuminance * (directional ? shell_reflected(dot(normal, ambient_lights[i].axis)) : shell_reflected_mean);
    if (sky) sum += sky_radiance_filtered(sky_data, ambient_data.sky_slot != no_texture ? sky_map(ambient_data.sky_slot, -normal, 0.0f) : vec3(1.0f));
    return ambient_data.albedo * sum;
}
/// Their radiance where a reflection looks: the shell is lit by what falls on its inside.
vec3 ambient_seen(vec3 direction, bool sky) {
    if (ambient_data.kind != ambient_directional) return ambient_diffuse(direction, sky);
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < ambient_data.light_count; ++i)
        sum += ambient_lights[i].illuminance * shell_radiance(dot(direction, ambient_lights[i].axis));
    if (sky) sum += sky_diffuse(-direction);
    return ambient_data.albedo * sum;
}

bool ambient_in_the_open() { return has_ambient && ambient_data.in_the_open != 0u; }

/// Both, as far as nothing is known to hide the sky.
vec3 surroundings_diffuse(vec3 normal, bool sky) {
    return (sky ? sky_diffuse(normal) : vec3(0.0f)) + (ambient_in_the_open() ? ambient_diffuse(normal, sky) : vec3(0.0f));
}
vec3 surroundings_specular(vec3 normal, vec3 wo, float roughness, bool sky) {
    vec3 sum = sky ? sky_specular(normal, wo, roughness) : vec3(0.0f);
    if (ambient_in_the_open()) sum += ambient_seen(dominant_reflection(normal, reflect(-wo, normal), roughness), sky);
    return sum;
}

#endif
