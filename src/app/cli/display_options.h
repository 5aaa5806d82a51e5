#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/scene_argument.h"
#include "core/image.h"
#include "scene/scene.h"

namespace heliodon::cli {

/// `MIN:MAX` or `MIN:MAX:log` of --false-colour, cd/m², or with `:lux` lux.
struct FalseColourRange {
    double low = 0, high = 1;
    bool logarithmic = false;
    bool illuminance = false;  ///< on the surfaces that are seen, instead of luminance
};
/// The picture's layer that false colour in lux shows.
inline constexpr const char* illuminance_layer_name = "illuminance";

/// How pictures are shown, where the command line has a word to say: it wins over the scene's `render` block.
struct DisplayOptions {
    std::optional<float> ev100;
    bool metered = false;  ///< --ev100 auto
    std::optional<ToneCurve> curve;
    std::optional<FalseColourRange> false_colour;
};
/// Declares --ev100, --tonemap and --false-colour.
void add_display_options(CLI::App& command, DisplayOptions& options);
/// Edits the scene's settings by the options.
void apply_display_options(const DisplayOptions& options, Scene& scene);

/// Sets the exposures of the pictures of one run, one after the other.
class Exposure {
public:
    /// `camera_ev100` counts where no meter decides. A picture `seconds` after the one before it (0: the first) has come
    /// as far from its exposure as eyes adapt.
    [[nodiscard]] float ev100(const Image& light, const ExposureSettings& settings, float camera_ev100, double seconds);

private:
    std::optional<float> before_;
};

/// `picture` (cd/m²) as a display file shows it: tone-mapped, or in false colour.
[[nodiscard]] Image shown(const Picture& picture, const DisplaySettings& settings, const DisplayOptions& options);

}  // namespace heliodon::cli
