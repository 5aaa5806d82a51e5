#include "app/cli/display_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/cli/false_colour.h"
#include "app/cli/option_values.h"
#include "convert/display.h"

namespace heliodon::cli {

void add_display_options(CLI::App& command, DisplayOptions& options) {
    using Text = const std::string&;
    command.add_option_function<std::string>(
        "--ev100",
        [&](Text text) {
            options.metered = text == "auto";
            if (!options.metered) options.ev100 = read_ev100(text);
        },
        "Exposure, instead of the camera's: a number, or auto: by a light meter on the picture (render.exposure says which)");
    command.add_option_function<std::string>(
        "--tonemap", [&](Text text) { options.curve = read_tone_curve(text); },
        "Tone curve: linear, hable, reinhard, aces, aces-narkowicz, agx or neutral; default as the scene says");
    command.add_option_function<std::string>(
        "--false-colour", [&](Text text) { options.false_colour = read_false_colour(text); },
        "MIN:MAX or MIN:MAX:log: .png and .jpg show luminance in cd/m2 in false colour, with iso-lines and a legend; with :lux "
        "behind it, illuminance on the surfaces that are seen, in lux");
}

void apply_display_options(const DisplayOptions& options, Scene& scene) {
    RenderSettings settings = scene.render_settings();
    if (options.ev100) settings.display.exposure.mode = ExposureMode::camera;
    if (options.metered && settings.display.exposure.mode == ExposureMode::camera)
        settings.display.exposure.mode = ExposureMode::metered;
    if (options.curve && *options.curve != settings.display.tone.curve) settings.display.tone = {.curve = *options.curve};
    scene.set_render_settings(std::move(settings));
}

float Exposure::ev100(const Image& light, const ExposureSettings& settings, float camera_ev100, double seconds) {
    if (settings.mode == ExposureMode::camera) return camera_ev100 - settings.compensation_ev;
    const float wanted = convert::exposure_ev100(settings, convert::meter(light, settings), camera_ev100);
    before_ = shading::adapted_ev100(before_.value_or(wanted), wanted, static_cast<float>(seconds), settings.to_light_s,
                                     settings.to_dark_s);
    return *before_;
}

Image shown(const Picture& picture, const DisplaySettings& settings, const DisplayOptions& options) {
    if (!options.false_colour) return convert::displayed(picture.image, settings, picture.ev100);
    const FalseColourRange& range = *options.false_colour;
    const IsoScale scale = range.logarithmic ? IsoScale::by_decades(range.low, range.high) : IsoScale::between(range.low, range.high);
    if (!range.illuminance) return draw_in_false_colour(picture.image, scale, "cd/m2");
    const auto layer = std::ranges::find(picture.layers, illuminance_layer_name, &Layer::name);
    return draw_in_false_colour(layer != picture.layers.end() ? layer->image : picture.image, scale, "lux");
}

}  // namespace heliodon::cli
