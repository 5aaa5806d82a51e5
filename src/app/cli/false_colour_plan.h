#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/image.h"

namespace heliodon::cli {

/// Display-encoded colour of `share` in [0, 1]: the cube helix, whose brightness grows evenly, so that it reads in
/// grey too (Green 2011, "A colour scheme for the display of astronomical intensity images", eq. 2).
[[nodiscard]] glm::vec3 false_colour(double share);

/// Round values from `low` to `high`, at each of which an iso-line passes.
class IsoScale {
public:
    /// From 0 to `most` or a little more, in some ten steps of 1, 2 or 5 times a power of ten.
    [[nodiscard]] static IsoScale from_zero(double most);
    /// The same steps within [low, high], its ends kept as they are.
    [[nodiscard]] static IsoScale between(double low, double high);
    /// 1, 2 and 5 times powers of ten within [low, high], 0 < low, evenly by the logarithm.
    [[nodiscard]] static IsoScale by_decades(double low, double high);

    [[nodiscard]] double share(double value) const;
    /// How many of the round values `value` reaches.
    [[nodiscard]] int level(double value) const;
    [[nodiscard]] const std::vector<double>& values() const { return values_; }
    [[nodiscard]] double low() const { return low_; }
    [[nodiscard]] double high() const { return high_; }

private:
    IsoScale(double low, double high, bool logarithmic) : low_(low), high_(high), logarithmic_(logarithmic) {}
    double low_, high_;
    bool logarithmic_;
    std::vector<double> values_;  // rising
};

/// A value as it stands in a legend.
[[nodiscard]] std::string iso_number(double value);

/// Draws `size` pixels of a quantity with its top left corner at `corner`, with iso-lines and their numbers. `value`
/// answers for a pixel (x, y) of the plan.
void draw_plan(Image& image, glm::ivec2 corner, glm::ivec2 size, const std::function<double(int, int)>& value, const IsoScale& scale);

/// Width and height in pixels that draw_legend takes.
[[nodiscard]] glm::ivec2 legend_size(const IsoScale& scale);
void draw_legend(Image& image, glm::ivec2 corner, const std::string& unit, const IsoScale& scale);

}  // namespace heliodon::cli
