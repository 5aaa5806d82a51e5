// Prefiltering an environment for split-sum lighting (Karis 2013, "Real Shading in Unreal Engine 4"):
// specular: the mean of the sky over reflections about the normal, weighted by N·L, with V = N; diffuse:
// irradiance / π, the cosine-weighted mean. Both are means, so that an even sky stays itself.
#ifndef HELIODON_SHADING_ENVIRONMENT_H
#define HELIODON_SHADING_ENVIRONMENT_H
#include "shading/ggx.h"
SHADING_BEGIN

/// Point `i` of `count` of the Hammersley set, its second coordinate the radical inverse in base 2.
SHADING_FN vec2 hammersley(uint i, uint count) {
    uint bits = i;
    bits = (bits << 16u) | (bits >> 16u);
    bits = ((bits & 0x55555555u) << 1u) | ((bits & 0xaaaaaaaau) >> 1u);
    bits = ((bits & 0x33333333u) << 2u) | ((bits & 0xccccccccu) >> 2u);
    bits = ((bits & 0x0f0f0f0fu) << 4u) | ((bits & 0xf0f0f0f0u) >> 4u);
    bits = ((bits & 0x00ff00ffu) << 8u) | ((bits & 0xff00ff00u) >> 8u);
    return vec2((float(i) + 0.5f) / float(count), float(bits >> 8u) * 5.9604644775390625e-8f);
}

struct PrefilterSample {
    vec3 direction;  // in the frame of the normal
    float weight;    // N·L; 0 below the horizon
    float pdf;       // per steradian
};
/// A reflection of the normal itself at α.
SHADING_FN PrefilterSample prefilter_sample(vec2 u, float alpha) {
    vec3 n = vec3(0.0f, 0.0f, 1.0f);
    vec3 h = ggx_sample_visible_normal(n, alpha, u);
    PrefilterSample result;
    result.direction = h * (2.0f * h.z) - n;
    result.weight = max(result.direction.z, 0.0f);
    result.pdf = 0.25f * ggx_distribution(h, alpha);
    return result;
}
/// Mip level of a map whose level 0 has texels of `texel_steradian` that one of `count` samples of density
/// `pdf` should read: Křivánek & Colbert 2008, "Real-time Shading with Filtered Importance Sampling", eq. 5.
SHADING_FN float prefilter_level(float pdf, uint count, float texel_steradian) {
    return max(0.5f * log2(1.0f / (max(pdf, 1.0e-20f) * float(count) * texel_steradian)), 0.0f);
}

/// The lobe of a rough surface leans from the mirror direction towards the normal: Lagarde & de Rousiers
/// 2014, listing 23 (the direction in which to look up the prefiltered map).
SHADING_FN vec3 dominant_reflection(vec3 n, vec3 mirror, float roughness) {
    float smoothness = clamp(1.0f - roughness, 0.0f, 1.0f);
    float factor = smoothness * (sqrt(smoothness) + roughness);
    return normalize(mix(n, mirror, factor));
}

SHADING_END
#endif
