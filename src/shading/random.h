// Counter-based random numbers: the same (pixel, sample, dimension, seed) gives the same numbers on
// every device, in any order, on any thread.
#ifndef HELIODON_SHADING_RANDOM_H
#define HELIODON_SHADING_RANDOM_H
#include "shading/language.h"
SHADING_BEGIN

/// Four independent 32-bit hashes of four counters. Jarzynski & Olano 2020, "Hash Functions for GPU
/// Rendering", listing of pcg4d; its multiplier and increment are those of Numerical Recipes' 32-bit LCG.
SHADING_FN uvec4 pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v.x = v.x ^ (v.x >> 16u);
    v.y = v.y ^ (v.y >> 16u);
    v.z = v.z ^ (v.z >> 16u);
    v.w = v.w ^ (v.w >> 16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

/// A uniform float in [0, 1): the upper 24 bits, so that rounding never gives 1.
SHADING_FN float uint_to_unit_float(uint bits) {
    return float(bits >> 8u) * 5.9604644775390625e-8f;
}

/// Four independent uniform numbers in [0, 1). `dimension` counts the calls within one sample.
SHADING_FN vec4 random4(uint pixel, uint sample_index, uint dimension, uint seed) {
    uvec4 bits = pcg4d(uvec4(pixel, sample_index, dimension, seed));
    return vec4(uint_to_unit_float(bits.x), uint_to_unit_float(bits.y), uint_to_unit_float(bits.z),
                uint_to_unit_float(bits.w));
}
SHADING_FN vec3 random3(uint pixel, uint sample_index, uint dimension, uint seed) {
    return vec3(random4(pixel, sample_index, dimension, seed));
}
SHADING_FN vec2 random2(uint pixel, uint sample_index, uint dimension, uint seed) {
    return vec2(random4(pixel, sample_index, dimension, seed));
}
SHADING_FN float random1(uint pixel, uint sample_index, uint dimension, uint seed) {
    return random4(pixel, sample_index, dimension, seed).x;
}

SHADING_END
#endif
