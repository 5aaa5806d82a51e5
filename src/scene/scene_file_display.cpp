// How light is shown: the render block's tonemap, exposure and white_balance.
#include <fmt/format.h>

#include "core/white_balance.h"
#include "scene/scene_file_parts.h"

namespace heliodon::scene_file {
namespace {

ToneCurve read_tone_curve(const JsonCursor& cursor) {
    return cursor.one_of<ToneCurve>({{"linear", ToneCurve::linear},
                                     {"hable", ToneCurve::hable},
                                     {"reinhard", ToneCurve::reinhard},
                                     {"aces", ToneCurve::aces},
                                     {"aces-narkowicz", ToneCurve::aces_narkowicz},
                                     {"agx", ToneCurve::agx},
                                     {"neutral", ToneCurve::neutral}});
}

/// A curve's name alone, or with what it can be told.
ToneSettings read_tone(const JsonCursor& cursor) {
    ToneSettings tone;
    if (!cursor.json().is_object()) {
        tone.curve = read_tone_curve(cursor);
        return tone;
    }
    ObjectReader object(cursor);
    tone.curve = read_tone_curve(object.require("curve"));
    if (const auto white = object.find("white")) {
        if (tone.curve != ToneCurve::hable && tone.curve != ToneCurve::reinhard)
            throw Refusal{white->path(), "expected with the curve \"hable\" or \"reinhard\": the others' white is fixed"};
        tone.estimate_white = white->json() == "auto";
        if (white->json().is_string() && !tone.estimate_white) white->refuse("a number above 0 or \"auto\"");
        if (!tone.estimate_white) tone.white = white->number(positive);
    }
    object.finish();
    return tone;
}

glm::vec2 read_percentiles(const JsonCursor& cursor) {
    constexpr Range percent{.low = 0, .high = 100};
    if (!cursor.json().is_array() || cursor.json().size() != 2) cursor.refuse("a list of 2 percentages");
    const auto elements = cursor.elements();
    const glm::vec2 shares = glm::vec2(elements[0].number(percent), elements[1].number(percent)) / 100.0f;
    if (!(shares.x < shares.y)) cursor.refuse("a lower percentage before a higher one");
    return shares;
}

ExposureSettings read_exposure(const JsonCursor& cursor) {
    constexpr Range stops{.low = -32, .high = 32};
    ObjectReader object(cursor);
    ExposureSettings exposure;
    if (const auto mode = object.find("mode"))
        exposure.mode = mode->one_of<ExposureMode>(
            {{"camera", ExposureMode::camera}, {"auto", ExposureMode::metered}, {"key", ExposureMode::key}});
    if (const auto metering = object.find("metering"))
        exposure.pattern = metering->one_of<MeteringPattern>(
            {{"average", MeteringPattern::average}, {"centre", MeteringPattern::centre}, {"spot", MeteringPattern::spot}});
    if (const auto mean = object.find("mean"))
        exposure.arithmetic_mean = mean->one_of<bool>({{"logarithmic", false}, {"arithmetic", true}});
    if (const auto percentiles = object.find("percentiles")) exposure.percentiles = read_percentiles(*percentiles);
    object.read("compensation_ev", exposure.compensation_ev, stops);
    object.read("to_light_s", exposure.to_light_s, not_negative);
    object.read("to_dark_s", exposure.to_dark_s, not_negative);
    object.finish();
    return exposure;
}

glm::vec2 read_white_balance(const JsonCursor& cursor) {
    constexpr Range kelvin{.low = least_color_temperature_k, .high = greatest_color_temperature_k};
    ObjectReader object(cursor);
    const auto temperature = object.find("temperature_k"), chromaticity = object.find("chromaticity");
    object.finish();
    if (temperature.has_value() == chromaticity.has_value())
        throw Refusal{cursor.path(), "expected either \"temperature_k\" or \"chromaticity\""};
    if (temperature) return white_chromaticity(temperature->number(kelvin));
    if (!chromaticity->json().is_array() || chromaticity->json().size() != 2) chromaticity->refuse("a list of 2 numbers");
    const auto elements = chromaticity->elements();
    constexpr Range share{.low = 0.05, .high = 0.9};  // what an adaptation can be asked for
    const glm::vec2 xy(elements[0].number(share), elements[1].number(share));
    if (xy.x + xy.y > 1) chromaticity->refuse("x and y that add up to 1 at most");
    return xy;
}

}  // namespace

DisplaySettings read_display(ObjectReader& render) {
    DisplaySettings settings;
    if (const auto tonemap = render.find("tonemap")) settings.tone = read_tone(*tonemap);
    if (const auto exposure = render.find("exposure")) settings.exposure = read_exposure(*exposure);
    if (const auto white = render.find("white_balance")) settings.white_balance = read_white_balance(*white);
    return settings;
}

}  // namespace heliodon::scene_file
