#ifndef HELIODON_HASH_GLSL
#define HELIODON_HASH_GLSL

/// PCG (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
uint pcg_hash(uint value) {
    const uint state = value * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}
/// [0, 1) from a hash's upper 24 bits.
float unit_interval(uint hash) { return float(hash >> 8u) * (1.0f / 16777216.0f); }

#endif
