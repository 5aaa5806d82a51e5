#include "app/cli/false_colour_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/cli/bitmap_text.h"

namespace heliodon::cli {
namespace {

constexpr int gap = 12, bar_width = 32, bar_height = 320;
constexpr glm::vec3 paper(1), ink(0);

bool is_dark(const glm::vec3& display) {
    return display.x + display.y + display.z < 1.5f;
}

/// Some ten steps of 1, 2 or 5 times a power of ten make up `range`.
double round_step(double range) {
    constexpr double steps = 10;
    const double rough = range / steps, power = std::pow(10, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= rough * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

/// Where each iso-line passes, and its level.
struct IsoPixel {
    glm::ivec2 at;
    int level;
};

/// One number on each iso-line, where it is farthest from the numbers there are and from the border.
void label_lines(Image& image, glm::ivec2 corner, glm::ivec2 size, const std::vector<IsoPixel>& lines, const IsoScale& scale) {
    std::vector<glm::ivec2> taken;
    const std::vector<double>& values = scale.values();
    for (int level = 1; level <= static_cast<int>(values.size()); ++level) {
        if (values[level - 1] >= scale.high()) continue;
        const std::string text = iso_number(values[level - 1]);
        const glm::ivec2 half = text_size(text) / 2 + 2;
        int best_room = 0;
        glm::ivec2 best(0);
        for (const IsoPixel& pixel : lines) {
            if (pixel.level != level) continue;
            const glm::ivec2 inside = glm::min(pixel.at - corner - half, corner + size - half - pixel.at);
            int room = std::min(inside.x, inside.y);
            for (const glm::ivec2& other : taken) {
                const glm::ivec2 apart = glm::abs(pixel.at - other) - 2 * half;
                room = std::min(room, std::max(apart.x, apart.y));
            }
            if (room > best_room) best_room = room, best = pixel.at;
        }
        if (best_room <= 0) continue;
        taken.push_back(best);
        const glm::vec3 color = false_colour(scale.share(values[level - 1]));
        fill_rectangle(image, best - half, best + half, color);
        draw_text(image, best - half + 2, text, is_dark(color) ? paper : ink);
    }
}

}  // namespace

glm::vec3 false_colour(double share) {
    constexpr double start = 0.5, rotations = -1.5, hue = 1;  // Green's defaults
    const double l = std::clamp(share, 0.0, 1.0), angle = 2 * std::numbers::pi * (start / 3 + rotations * l);
    const double amplitude = hue * l * (1 - l) / 2, c = std::cos(angle), s = std::sin(angle);
    const glm::dvec3 color(l + amplitude * (-0.14861 * c + 1.78277 * s), l + amplitude * (-0.29227 * c - 0.90649 * s),
                           l + amplitude * (1.97294 * c));
    return glm::vec3(glm::clamp(color, 0.0, 1.0));
}

IsoScale IsoScale::from_zero(double most) {
    if (!(most > 0) || !std::isfinite(most)) most = 1;
    const double step = round_step(most);
    return between(0, step * std::ceil(most / step * (1 - 1e-9)));
}

IsoScale IsoScale::between(double low, double high) {
    IsoScale scale(low, high, false);
    const double step = round_step(high - low);
    for (double n = std::ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; ++n)
        if (n * step > low) scale.values_.push_back(n * step);
    return scale;
}

IsoScale IsoScale::by_decades(double low, double high) {
    IsoScale scale(low, high, true);
    for (double power = std::pow(10, std::floor(std::log10(low))); power <= high; power *= 10)
        for (const double factor : {1.0, 2.0, 5.0})
            if (factor * power > low && factor * power <= high * (1 + 1e-9)) scale.values_.push_back(factor * power);
    return scale;
}

double IsoScale::share(double value) const {
    if (logarithmic_) return value > 0 ? std::log(value / low_) / std::log(high_ / low_) : 0;
    return (value - low_) / (high_ - low_);
}

int IsoScale::level(double value) const {
    return static_cast<int>(std::upper_bound(values_.begin(), values_.end(), value * (1 + 1e-12)) - values_.begin());
}

std::string iso_number(double value) {
    return fmt::format("{:.6g}", value);
}

void draw_plan(Image& image, glm::ivec2 corner, glm::ivec2 size, const std::function<double(int, int)>& value, const IsoScale& scale) {
    std::vector<double> values(static_cast<std::size_t>(size.x) * size.y);
    const auto at = [&](int x, int y) -> double& { return values[static_cast<std::size_t>(y) * size.x + x]; };
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) at(x, y) = value(x, y);
    std::vector<IsoPixel> lines;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            glm::vec3 color = false_colour(scale.share(at(x, y)));
            const int here = scale.level(at(x, y)), right = scale.level(at(std::min(x + 1, size.x - 1), y)),
                      below = scale.level(at(x, std::min(y + 1, size.y - 1)));
            if (here != right || here != below) {
                color = is_dark(color) ? paper : ink;
                lines.push_back({corner + glm::ivec2(x, y), std::max({here, right, below})});
            }
            for (int c = 0; c < 3; ++c) image.at(corner.x + x, corner.y + y, c) = color[c];
        }
    label_lines(image, corner, size, lines, scale);
}

glm::ivec2 legend_size(const IsoScale& scale) {
    int widest = text_size(iso_number(scale.low())).x;
    for (const double value : scale.values()) widest = std::max(widest, text_size(iso_number(value)).x);
    return {bar_width + gap + std::max(widest, text_size("cd/m2").x - bar_width), bar_height + 2 * (text_size("lx").y + gap)};
}

void draw_legend(Image& image, glm::ivec2 corner, const std::string& unit, const IsoScale& scale) {
    draw_text(image, corner, unit, ink);
    corner.y += text_size(unit).y + gap;
    for (int y = 0; y < bar_height; ++y)
        fill_rectangle(image, corner + glm::ivec2(0, y), corner + glm::ivec2(bar_width, y + 1), false_colour(1 - (y + 0.5) / bar_height));
    std::vector<double> marks = scale.values();
    marks.insert(marks.begin(), scale.low());
    for (const double value : marks) {
        const int y = corner.y + bar_height - static_cast<int>(std::lround(bar_height * scale.share(value)));
        const std::string text = iso_number(value);
        fill_rectangle(image, {corner.x + bar_width, y - 1}, {corner.x + bar_width + gap / 2, y + 1}, ink);
        draw_text(image, {corner.x + bar_width + gap, y - text_size(text).y / 2 + text_scale}, text, ink);
    }
}

}  // namespace heliodon::cli
