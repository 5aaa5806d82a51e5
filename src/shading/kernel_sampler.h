// Counter-based low-discrepancy samples: the Sobol' (0,2)-sequence with hash-based Owen scrambling, one
// independently shuffled copy for each dimension pair (Burley 2020, "Practical Hash-based Owen Scrambling").
#ifndef HELIODON_SHADING_KERNEL_SAMPLER_H
#define HELIODON_SHADING_KERNEL_SAMPLER_H
#include "shading/language.h"
SHADING_BEGIN

/// Integer bijection with low bias (Wellons 2018, "lowbias32").
SHADING_FN uint kernel_hash(uint x) {
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    x ^= x >> 16u;
    return x;
}

SHADING_FN uint kernel_hash_combine(uint seed, uint value) {
    return kernel_hash(seed ^ (kernel_hash(value + 0x9e3779b9u) + (seed << 6u)));
}

#ifdef __cplusplus
SHADING_FN uint kernel_reverse_bits(uint x) {
    x = __builtin_bswap32(x);
    x = ((x & 0x0f0f0f0fu) << 4u) | ((x >> 4u) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2u) | ((x >> 2u) & 0x33333333u);
    x = ((x & 0x55555555u) << 1u) | ((x >> 1u) & 0x55555555u);
    return x;
}
/// Both at the cost of one.
SHADING_FN uvec2 kernel_reverse_both(uint x, uint y) {
    const auto twice = [](uint mask) { return std::uint64_t{mask} << 32u | mask; };
    std::uint64_t both = std::uint64_t{x} << 32u | y;
    both = __builtin_bswap64(both);
    both = ((both & twice(0x0f0f0f0fu)) << 4u) | ((both >> 4u) & twice(0x0f0f0f0fu));
    both = ((both & twice(0x33333333u)) << 2u) | ((both >> 2u) & twice(0x33333333u));
    both = ((both & twice(0x55555555u)) << 1u) | ((both >> 1u) & twice(0x55555555u));
    return uvec2(static_cast<uint>(both), static_cast<uint>(both >> 32u));
}
#else
uint kernel_reverse_bits(uint x) { return bitfieldReverse(x); }
uvec2 kernel_reverse_both(uint x, uint y) { return uvec2(bitfieldReverse(x), bitfieldReverse(y)); }
#endif

/// Owen scrambling of bit-reversed values: each bit is flipped by a hash of the bits below it
/// (Laine and Karras 2011, with Vegdahl's 2021 constants).
SHADING_FN uint kernel_owen_reversed(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// The second Sobol' dimension, bit-reversed: Pascal's triangle modulo 2, which is the substitution
/// x → x + 1 in the polynomial whose coefficients are the index's bits (Sobol' 1967).
SHADING_FN uint kernel_sobol_second_reversed(uint index) {
    index ^= (index >> 16u) & 0x0000ffffu;
    index ^= (index >> 8u) & 0x00ff00ffu;
    index ^= (index >> 4u) & 0x0f0f0f0fu;
    index ^= (index >> 2u) & 0x33333333u;
    index ^= (index >> 1u) & 0x55555555u;
    return index;
}

/// [0, 1): the upper 24 bits, so that the result never rounds up to 1.
SHADING_FN float kernel_unit_float(uint x) { return float(x >> 8u) * 5.9604644775390625e-8f; }

SHADING_FN vec2 kernel_unit_pair(uint x_reversed, uint y_reversed) {
    const uvec2 both = kernel_reverse_both(x_reversed, y_reversed);
    return vec2(kernel_unit_float(both.x), kernel_unit_float(both.y));
}

/// The first of the two alone.
SHADING_FN float kernel_sample_first(uint index_reversed, uint seed) {
    const uint shuffled = kernel_reverse_bits(kernel_owen_reversed(index_reversed, kernel_hash(seed)));
    return kernel_unit_float(kernel_reverse_bits(kernel_owen_reversed(shuffled, kernel_hash(seed ^ 0x68bc21ebu))));
}

/// The `index`-th point (given bit-reversed) of the pair of dimensions that `seed` names.
SHADING_FN vec2 kernel_sample_pair(uint index_reversed, uint seed) {
    const uint shuffled = kernel_reverse_bits(kernel_owen_reversed(index_reversed, kernel_hash(seed)));
    const uint x = kernel_owen_reversed(shuffled, kernel_hash(seed ^ 0x68bc21ebu));
    const uint y = kernel_owen_reversed(kernel_sobol_second_reversed(shuffled), kernel_hash(seed ^ 0x02e5be93u));
    return kernel_unit_pair(x, y);
}

SHADING_END
#endif
