// Samples of neighbouring pixels that fill each other's gaps, so that their errors differ and hide at high spatial
// frequencies (blue noise), as in Ahmed & Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error
// via Hierarchical Ordering of Pixels"; for any number of samples, one after another.
//
// A tile's pixels share one Owen scrambling of the Sobol' (0,2)-sequence, which each shifts by digits of its own. With
// its first 2^k samples each pixel has one point in every interval of k digits; the digits behind decide where in it.
// Digit n of pixel p's shift is the sum over j of C(n, j) p_j modulo 2, p_j the bits of its number along a Z curve: any q
// such digits one after another, wherever they begin, are different for the 2^q pixels of a square (Pascal's matrix has
// no singular such minor), so that for every k at once the square's points together are again one in every interval of
// k + q digits. Two dimensions cannot both be so perfect in base 2: the shift of the second takes the number
// p + ⌊p/2²⌋ + ⌊p/2³⌋ + ⌊p/2⁵⌋ (sums without carry), of all such sums the one whose squares of 2 to 64 pixels with
// 1 to 256 samples come nearest to nets.
#ifndef HELIODON_SHADING_KERNEL_TILE_SAMPLER_H
#define HELIODON_SHADING_KERNEL_TILE_SAMPLER_H
#include "shading/kernel_sampler.h"
SHADING_BEGIN

/// Events of a path whose numbers the pixels of a tile share out; of later ones too little comes through.
SHADING_CONST uint kernel_tiled_events = 2u;

SHADING_FN uint kernel_spread_bits(uint x) {
    x = (x | (x << 4u)) & 0x0f0f0f0fu;
    x = (x | (x << 2u)) & 0x33333333u;
    return (x | (x << 1u)) & 0x55555555u;
}
/// Place along a Z curve (Morton 1966) of coordinates below 16.
SHADING_FN uint kernel_morton(uint x, uint y) { return kernel_spread_bits(x) | (kernel_spread_bits(y) << 1u); }

/// Bit n of the result: the sum of C(n, j) x_j modulo 2, which runs over the j whose bits are a subset of n's (Lucas).
SHADING_FN uint kernel_pascal(uint x) {
    x ^= (x & 0x55555555u) << 1u;
    x ^= (x & 0x33333333u) << 2u;
    x ^= (x & 0x0f0f0f0fu) << 4u;
    x ^= (x & 0x00ff00ffu) << 8u;
    return x ^ (x << 16u);
}

/// As kernel_sample_pair, for the pixel at the place of its tile given bit-reversed; `seed` is the tile's.
SHADING_FN vec2 kernel_tile_pair(uint index_reversed, uint place_reversed, uint seed) {
    // Each pair of dimensions has the squares within squares in an order of its own.
    const uvec2 both = kernel_reverse_both(kernel_owen_reversed(place_reversed, kernel_hash(seed ^ 0x51633e2du)),
                                           kernel_owen_reversed(index_reversed, kernel_hash(seed)));
    const uint place = both.x;
    const uint shuffled = both.y;
    const uint x = shuffled ^ kernel_pascal(place);
    const uint y = kernel_sobol_second_reversed(shuffled) ^ kernel_pascal(place ^ (place >> 2u) ^ (place >> 3u) ^ (place >> 5u));
    return kernel_unit_pair(kernel_owen_reversed(x, kernel_hash(seed ^ 0x68bc21ebu)), kernel_owen_reversed(y, kernel_hash(seed ^ 0x02e5be93u)));
}

SHADING_END
#endif
