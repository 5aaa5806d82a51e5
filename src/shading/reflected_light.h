// What a surface that is known by its albedo reflects of a light from one direction (docs/gi-theory.md).
#ifndef HELIODON_SHADING_REFLECTED_LIGHT_H
#define HELIODON_SHADING_REFLECTED_LIGHT_H
#include "shading/lobe_cone.h"
#include "shading/spherical_lobe.h"
SHADING_BEGIN

/// The part of a surface's albedo that is specular, where only its mean is known: as grey as the albedo allows. What a
/// dielectric reflects specularly is white, what a metal reflects is nothing else.
SHADING_FN vec3 specular_part(vec3 albedo, float mean) {
    float low = min(albedo.x, min(albedo.y, albedo.z));
    float high = max(albedo.x, max(albedo.y, albedo.z));
    float middle = albedo.x + albedo.y + albedo.z - low - high;
    float most = mean;
    if (mean > low) {
        most = 0.5f * (3.0f * mean - low);
        if (most > middle) {
            most = 3.0f * mean - low - middle;
        }
    }
    return min(albedo, vec3(max(most, 0.0f)));
}

SHADING_FN vec3 reflected_lobe_entry(uint index) {
    return vec3(shading_table(index), shading_table(index + 1u), shading_table(index + 2u));
}
/// The lobe of radiance that a plane reflects of light at cosine `mu` (plane_lobe.h): its mean, x along the light's side, y
/// along the normal, and its clamped cosine; bilinear in √μ and √α.
SHADING_FN vec3 reflected_lobe(float mu, float alpha, uint layer) {
    LobeTableCell cell = lobe_table_cell(mu, alpha, layer, reflected_lobe_rows, reflected_lobe_columns);
    uint first = reflected_lobe_start + 3u * cell.entry;
    uint next = first + 3u * reflected_lobe_columns;
    return mix(mix(reflected_lobe_entry(first), reflected_lobe_entry(first + 3u), cell.x),
               mix(reflected_lobe_entry(next), reflected_lobe_entry(next + 3u), cell.x), cell.y);
}

/// What a surface reflects of a light from one direction.
struct ReflectedLight {
    vec3 diffuse;          // albedo
    vec3 specular;         // likewise
    vec3 mean;             // of the specular lobe of radiance over the sphere
    float clamped_cosine;  // likewise, of max(0, cosine to the normal)
};
SHADING_CONST float even_field_cosine = 0.666666667f;  // mean of a diffuse field, ∫cos² / ∫cos

/// `albedo` and, of it, `specular` (mean of the channels): at even_field_cosine; `wi`: to the light, wi.z > 0. What GGX reflects
/// the other layer does not (dielectric_below()).
SHADING_FN ReflectedLight reflected_light(vec3 albedo, float specular, float alpha, vec3 wi) {
    ReflectedLight result;
    vec3 at_mean = specular_part(albedo, specular);
    vec2 split_at_mean = ggx_albedo_split(even_field_cosine, alpha);
    vec2 split = ggx_albedo_split(wi.z, alpha);
    vec3 f0 = f0_of_albedo(at_mean, split_at_mean);
    vec3 grows = (f0 * split.x + vec3(split.y)) / max(f0 * split_at_mean.x + vec3(split_at_mean.y), vec3(1.0e-6f));
    result.specular = min(at_mean * grows, vec3(1.0f));
    float passed_at_mean = 1.0f - (at_mean.x + at_mean.y + at_mean.z) * (1.0f / 3.0f);
    float passed = 1.0f - (result.specular.x + result.specular.y + result.specular.z) * (1.0f / 3.0f);
    result.diffuse = (albedo - at_mean) * (passed / max(passed_at_mean, 1.0e-6f));
    // A mixture of the lobes at F0 = 1 and lobe_dielectric_f0 by their energies, as in specular_cone().
    float mean_f0 = (f0.x + f0.y + f0.z) * (1.0f / 3.0f);
    float dielectric = min(1.0f - mean_f0, 0.98f) / (1.0f - lobe_dielectric_f0);
    vec2 energies = vec2((1.0f - dielectric) * (split.x + split.y), dielectric * (lobe_dielectric_f0 * split.x + split.y));
    vec3 bare = reflected_lobe(wi.z, alpha, 0u);
    vec3 coated = reflected_lobe(wi.z, alpha, 1u);
    // Amplitudes over the sphere are energies over clamped cosines.
    vec2 amplitudes = energies / max(vec2(bare.z, coated.z), vec2(1.0e-4f));
    float amplitude = max(amplitudes.x + amplitudes.y, 1.0e-6f);
    vec3 lobe = (bare * amplitudes.x + coated * amplitudes.y) * (1.0f / amplitude);
    float across = sqrt(wi.x * wi.x + wi.y * wi.y);
    vec2 x = across > 0.0f ? vec2(wi.x, wi.y) * (1.0f / across) : vec2(1.0f, 0.0f);
    result.mean = vec3(lobe.x * x.x, lobe.x * x.y, lobe.y);
    result.clamped_cosine = (energies.x + energies.y) / amplitude;
    return result;
}

SHADING_END
#endif
