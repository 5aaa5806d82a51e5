#include "convert/display.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/white_balance.h"

namespace heliodon::convert {
namespace {

using namespace heliodon::shading;

/// The counts of one ring of a picture, or of both.
struct Histogram {
    std::array<std::array<std::uint32_t, metering_bins>, 2> counts{}, sums{};

    [[nodiscard]] uint metering_count(uint ring, uint bin) const { return counts[ring][bin]; }
    [[nodiscard]] uint metering_sum(uint ring, uint bin) const { return sums[ring][bin]; }
// The include defines member functions, which read but do not change this.
#include "shading/metering_fetch.h"
};

Histogram histogram(const Image& image, std::uint32_t pattern) {
    Histogram made;
    const auto width = static_cast<uint>(image.width), height = static_cast<uint>(image.height);
    const uint stride = metering_stride(width, height);
    for (uint y = 0; y < height; y += stride)
        for (uint x = 0; x < width; x += stride) {
            const float light = luminance(image.rgb(static_cast<int>(x), static_cast<int>(y)));
            const float place = metering_place(std::isfinite(light) ? light : 0.0f);
            const uint ring = metering_inside(pattern, x, y, width, height) ? 0 : 1, bin = static_cast<uint>(place);
            ++made.counts[ring][bin];
            made.sums[ring][bin] += metering_steps(place);
        }
    return made;
}

}  // namespace

std::uint32_t tone_curve(ToneCurve curve) {
    switch (curve) {
        case ToneCurve::linear: return tone_curve_linear;
        case ToneCurve::hable: return tone_curve_hable;
        case ToneCurve::reinhard: return tone_curve_reinhard;
        case ToneCurve::aces: return tone_curve_aces;
        case ToneCurve::aces_narkowicz: return tone_curve_aces_narkowicz;
        case ToneCurve::agx: return tone_curve_agx;
        case ToneCurve::neutral: return tone_curve_neutral;
    }
    return tone_curve_linear;
}

std::uint32_t metering_pattern(MeteringPattern pattern) {
    switch (pattern) {
        case MeteringPattern::average: return metering_average;
        case MeteringPattern::centre: return metering_centre;
        case MeteringPattern::spot: return metering_spot;
    }
    return metering_average;
}

float tone_white(const ToneSettings& tone, const Metering& metering) {
    if (tone.estimate_white) return estimated_white(metering);
    if (tone.white > 0) return tone.white;
    return tone.curve == ToneCurve::reinhard ? reinhard_white : hable_white;
}

glm::mat3 white_balance(const DisplaySettings& settings) {
    return settings.white_balance ? white_balance_matrix(*settings.white_balance) : glm::mat3(1);
}

Metering meter(const Image& image, const ExposureSettings& settings) {
    const std::uint32_t pattern = metering_pattern(settings.pattern);
    return histogram(image, pattern)
        .metering_read(pattern, settings.arithmetic_mean, settings.percentiles.x, settings.percentiles.y);
}

float exposure_ev100(const ExposureSettings& settings, const Metering& metering, float camera_ev100) {
    if (settings.mode == ExposureMode::metered)
        return ev100_from_metered_luminance(metering.luminance_nits) - settings.compensation_ev;
    if (settings.mode == ExposureMode::key) return ev100_from_key(metering) - settings.compensation_ev;
    return camera_ev100 - settings.compensation_ev;
}

Image displayed(const Image& light, const DisplaySettings& settings, float ev100) {
    Image shown(light.width, light.height, 3);
    const glm::mat3 balanced_and_exposed = white_balance(settings) * exposure_scale(ev100);
    const Metering metering = settings.tone.estimate_white ? meter(light, settings.exposure) : Metering{};
    const float white = tone_white(settings.tone, metering);
    const std::uint32_t curve = tone_curve(settings.tone.curve);
    for (int y = 0; y < shown.height; ++y)
        for (int x = 0; x < shown.width; ++x) {
            const glm::vec3 color = srgb_encode_rgb(tone_map(curve, white, balanced_and_exposed * light.rgb(x, y)));
            for (int c = 0; c < 3; ++c) shown.at(x, y, c) = color[c];
        }
    return shown;
}

}  // namespace heliodon::convert
