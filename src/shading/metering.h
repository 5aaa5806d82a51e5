// What a light meter reads off a picture: a histogram of its luminance, and the exposure by it. The histogram is made of
// whole numbers, so that it is the same however many threads count.
#ifndef HELIODON_SHADING_METERING_H
#define HELIODON_SHADING_METERING_H
#include "core/units.h"
#include "shading/language.h"
SHADING_BEGIN

/// Eighths of a stop from 2⁻¹² cd/m² (starlight on paper) to 2²⁰ cd/m²; what lies beyond counts as the end.
SHADING_CONST uint metering_bins = 256u;
SHADING_CONST float metering_bins_a_stop = 8.0f;
SHADING_CONST float metering_least_stop = -12.0f;
/// A pixel's place within its bin is summed in so many steps, which keeps means exact to a fiftieth of a bin.
SHADING_CONST uint metering_steps_a_bin = 63u;

SHADING_CONST uint metering_average = 0u;
SHADING_CONST uint metering_centre = 1u;
SHADING_CONST uint metering_spot = 2u;

/// Of very large pictures every second row and column counts, so that sums stay within 32 bits.
SHADING_FN uint metering_stride(uint width, uint height) {
    return width > 8192u || height > 8192u ? 2u : 1u;
}

/// Where `luminance_nits` stands on the histogram's axis, in bins.
SHADING_FN float metering_place(float luminance_nits) {
    float stop = log2(max(luminance_nits, exp2(metering_least_stop)));
    return clamp((stop - metering_least_stop) * metering_bins_a_stop, 0.0f, float(metering_bins) - 0.001f);
}
/// The inverse: log2 of the luminance in cd/m².
SHADING_FN float metering_stop(float place) {
    return metering_least_stop + place / metering_bins_a_stop;
}
SHADING_FN uint metering_steps(float place) {
    return uint((place - floor(place)) * float(metering_steps_a_bin) + 0.5f);
}

/// Radius of the circle that a pattern singles out, in heights of a 36 × 24 mm frame: 12 mm and 4 mm across
/// (the centre-weighted and spot meters of Nikon's F cameras).
SHADING_FN float metering_radius(uint pattern) {
    return pattern == metering_spot ? 2.0f / 24.0f : 6.0f / 24.0f;
}
/// The share of the whole reading that what lies in the circle has: as much as its pixels, three quarters, or all.
SHADING_FN float metering_inner_share(uint pattern, float inner_pixels, float outer_pixels) {
    if (inner_pixels == 0.0f || outer_pixels == 0.0f) {
        return inner_pixels > 0.0f ? 1.0f : 0.0f;
    }
    if (pattern == metering_average) {
        return inner_pixels / (inner_pixels + outer_pixels);
    }
    return pattern == metering_spot ? 1.0f : 0.75f;
}
/// Whether the middle of a pixel lies in that circle. A picture has at least one such pixel.
SHADING_FN bool metering_inside(uint pattern, uint x, uint y, uint width, uint height) {
    vec2 from_centre = vec2(float(x) + 0.5f - 0.5f * float(width), float(y) + 0.5f - 0.5f * float(height));
    float radius = max(metering_radius(pattern) * float(height), 0.75f);
    return dot(from_centre, from_centre) <= radius * radius;
}

/// What the meter says. Stops are log2 of cd/m².
struct Metering {
    float luminance_nits;  // the mean asked for, of what lies between the percentiles
    float mean_stop;       // the mean of the logarithm, of the same
    float low_stop;        // 1 % of the reading is darker
    float high_stop;       // 1 % is brighter
};

/// The exposure at which a camera's meter puts `luminance_nits` (ISO 2720:1974 with K = 12.5): EV100 = log2(L·100/K).
SHADING_FN float ev100_from_metered_luminance(float luminance_nits) {
    return log2(luminance_nits * (100.0f / 12.5f));
}

/// Reinhard 2002, "Parameter Estimation for Photographic Tone Reproduction", eq. 4: the key, what the log-average becomes.
SHADING_FN float estimated_key(SHADING_IN(Metering) m) {
    float range = max(m.high_stop - m.low_stop, 1e-3f);
    return 0.18f * pow(4.0f, (2.0f * m.mean_stop - m.low_stop - m.high_stop) / range);
}
/// The exposure that gives the log-average the estimated key: 1/(1.2·2^EV100) = key/L.
SHADING_FN float ev100_from_key(SHADING_IN(Metering) m) {
    return m.mean_stop - log2(1.2f * estimated_key(m));
}
/// The same paper, eq. 5: the exposed value that becomes white. Never below the key's own grey, so that a picture of one
/// luminance stays as it is exposed.
SHADING_FN float estimated_white(SHADING_IN(Metering) m) {
    return max(1.5f * exp2(m.high_stop - m.low_stop - 5.0f), estimated_key(m));
}

/// How far an exposure has come after `seconds`: exponentially, by a time constant for each direction.
SHADING_FN float adapted_ev100(float before, float wanted, float seconds, float to_light_s, float to_dark_s) {
    float time_constant = wanted > before ? to_light_s : to_dark_s;
    return time_constant > 0.0f ? wanted + (before - wanted) * exp(-seconds / time_constant) : wanted;
}

SHADING_END
#endif
