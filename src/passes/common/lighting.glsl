// Light that arrives at a surface point from the scene's lights and the sky and leaves towards the viewer.
#ifndef HELIODON_LIGHTING_GLSL
#define HELIODON_LIGHTING_GLSL
#include "passes/common/light_visibility.glsl"
#include "passes/common/surface.glsl"
#include "passes/common/hash.glsl"
#include "passes/common/sky_light.glsl"
#include "passes/light_grid/light_choice.glsl"
#include "passes/common/luminaires.glsl"

layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
float shading_table(uint index) { return shading_tables[index]; }

LightData batch_light(FrameData frame, uint index) { return shining_light(frame.light_first + index); }

LightSample light_arriving(vec3 position, LightData light, uint index, uint pixel_seed) {
    const uint seed = pcg_hash(pixel_seed + index);
    return scene_light_sample(light, position, vec2(unit_interval(seed), unit_interval(pcg_hash(seed))));
}

vec3 light_reflected(SurfacePoint point, BsdfLobes lobes, vec3 wo, uint index, FrameData frame, uint pixel_seed) {
    const LightData light = batch_light(frame, index);
    const LightSample arriving = light_arriving(point.position, light, index, pixel_seed);
    if (arriving.value == vec3(0.0f)) return vec3(0.0f);
    const vec3 wi = to_local(point.frame, arriving.direction);
    const vec3 reflected = bsdf_evaluate_prepared(point.material.surface, lobes, wo, wi) *
                           same_side(arriving.direction, point.geometric, wi.z) * arriving.value;
    if (reflected == vec3(0.0f)) return vec3(0.0f);
    return reflected * light_reaching(light, index, point.position, point.geometric, frame.shadow_filter);
}

// A sample picks lights by their grid cell, and of each four of these one by what it gives the surface itself.
const uint light_picks_a_sample = 32u;
const uint picks_a_group = 4u;

/// What chances among picked lights are in proportion to: unshadowed illuminance; 0 only where the light cannot matter.
float pick_value(SurfacePoint point, uint index, FrameData frame, uint pixel_seed) {
    const LightSample arriving = light_arriving(point.position, batch_light(frame, index), index, pixel_seed);
    const float cosine = dot(arriving.direction, point.frame.normal);
    const bool transmits = point.material.surface.transmission > 0.0f;
    return luminance(arriving.value) * (transmits ? abs(cosine) : max(cosine, 0.0f));
}

/// Resampled importance sampling (Talbot, Cline & Egbert 2005, "Importance Resampling for Global Illumination", eq. 6).
vec3 lights_reflected(SurfacePoint point, BsdfLobes lobes, vec3 wo, FrameData frame, uint pixel_seed) {
    vec3 sum = vec3(0.0f);
    uint seed = pcg_hash(~pixel_seed);
    LightPicks picks = light_picks(point.position, frame.light_count, light_picks_a_sample, unit_interval(seed));
    const uint group = picks.all ? 1u : picks_a_group;
    LightPick pick;
    bool more = true;
    while (more) {
        float total = 0.0f;
        float chosen_value = 1.0f;
        uint chosen = 0u;
        for (uint i = 0u; i < group && more; ++i) {
            more = next_light(picks, pick);
            if (!more) break;
            const float value = picks.all ? 1.0f : pick_value(point, pick.light, frame, pixel_seed);
            const float weight = pick.weight * value;
            total += weight;
            seed = pcg_hash(seed);
            if (unit_interval(seed) * total >= weight) continue;
            chosen = pick.light;
            chosen_value = value;
        }
        if (total > 0.0f) sum += total / chosen_value * light_reflected(point, lobes, wo, chosen, frame, pixel_seed);
    }
    return sum;
}

/// The open sky, and what surroundings reflect, by split sums; occlusion darkens their diffuse part alone.
vec3 sky_reflected(SurfacePoint point, BsdfLobes lobes, bool sky) {
    const Surface surface = point.material.surface;
    const vec3 normal = point.frame.normal;
    vec3 sum = bsdf_diffuse_albedo_prepared(surface, lobes) * point.material.occlusion * surroundings_diffuse(normal, sky);
    sum += bsdf_specular_albedo_prepared(surface, lobes) * surroundings_specular(normal, point.wo, surface.roughness, sky);
    if (lobes.coat_albedo > 0.0f)
        sum += bsdf_coat_albedo_prepared(lobes) * surroundings_specular(normal, point.wo, surface.clearcoat_roughness, sky);
    return sum;
}

/// Radiance towards the viewer (`wo`, local): this batch's lights; emission and sky with the first batch.
vec3 surface_radiance(SurfacePoint point, vec3 wo, BsdfLobes lobes, FrameData frame, uint pixel_seed) {
    if (point.dark) return vec3(0.0f);
    vec3 radiance = lights_reflected(point, lobes, wo, frame, pixel_seed);
    if (frame.batch == 0u) {
        radiance += point.material.emission;
        const bool sky = sky_shines(frame.sky_enabled);
        if (!sky_follows && (sky || has_ambient) && frame.cone_traced == 0u && wo.z > 0.0f) radiance += sky_reflected(point, lobes, sky);
    }
    return radiance;
}
vec3 surface_radiance(SurfacePoint point, FrameData frame, uint pixel_seed) {
    const vec3 wo = to_local(point.frame, point.wo);
    return surface_radiance(point, wo, bsdf_prepare(point.material.surface, wo), frame, pixel_seed);
}

#endif
