// A meter's reading of a histogram, through the includer (as material_fetch.h: no namespace, no include guard).
//
// The includer has defined:
//   uint metering_count(uint ring, uint bin)  pixels; ring 0 within the circle, 1 outside
//   uint metering_sum(uint ring, uint bin)    of their metering_steps

/// The share of one bin in the whole reading, and where its pixels lie in the mean, in bins.
struct MeteringBin {
    float share;
    float place;
};
SHADING_FN MeteringBin metering_bin(uint bin, float inner_weight, float outer_weight) {
    uint inner = metering_count(0u, bin);
    uint outer = metering_count(1u, bin);
    float inner_share = float(inner) * inner_weight;
    float outer_share = float(outer) * outer_weight;
    float steps = float(metering_sum(0u, bin)) * inner_weight + float(metering_sum(1u, bin)) * outer_weight;
    MeteringBin read;
    read.share = inner_share + outer_share;
    read.place = float(bin) + (read.share > 0.0f ? steps / (read.share * float(metering_steps_a_bin)) : 0.5f);
    return read;
}

/// The reading by `pattern`, leaving out what lies below and above two percentiles (0 and 1: nothing). `arithmetic`: the
/// mean of the luminance instead of its logarithm's, which leaves out what has no light (the least bin): there is nothing.
SHADING_FN Metering metering_read(uint pattern, bool arithmetic, float low_percentile, float high_percentile) {
    float inner_pixels = 0.0f;
    float outer_pixels = 0.0f;
    uint first = arithmetic ? 0u : 1u;
    for (uint bin = first; bin < metering_bins; ++bin) {
        inner_pixels += float(metering_count(0u, bin));
        outer_pixels += float(metering_count(1u, bin));
    }
    float inner_share = metering_inner_share(pattern, inner_pixels, outer_pixels);
    float inner_weight = inner_share / max(inner_pixels, 1.0f);
    float outer_weight = (1.0f - inner_share) / max(outer_pixels, 1.0f);

    float extreme = 0.01f;
    Metering m;
    m.low_stop = metering_stop(0.0f);
    m.high_stop = m.low_stop;
    float passed = 0.0f;
    float counted = 0.0f;
    float sum = 0.0f;
    float sum_of_stops = 0.0f;
    for (uint bin = first; bin < metering_bins; ++bin) {
        MeteringBin read = metering_bin(bin, inner_weight, outer_weight);
        if (read.share == 0.0f) {
            continue;
        }
        float stop = metering_stop(read.place);
        if (passed <= extreme) {
            m.low_stop = stop;
        }
        if (passed < 1.0f - extreme) {
            m.high_stop = stop;
        }
        float part = max(min(passed + read.share, high_percentile) - max(passed, low_percentile), 0.0f);
        counted += part;
        sum += part * exp2(stop);
        sum_of_stops += part * stop;
        passed += read.share;
    }
    m.mean_stop = counted > 0.0f ? sum_of_stops / counted : metering_stop(0.0f);
    m.luminance_nits = arithmetic && counted > 0.0f ? sum / counted : exp2(m.mean_stop);
    return m;
}
