#include "app/cli/false_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/cli/bitmap_text.h"

namespace heliodon::cli {
namespace {

constexpr int plan_side = 720, margin = 24, gap = 12, bar_width = 32, bar_height = 320;
constexpr glm::vec3 paper(1), ink(0);

/// Values from 0 to `top` in round steps.
struct Scale {
    double step = 1, top = 1;
    [[nodiscard]] int levels() const { return static_cast<int>(std::lround(top / step)); }
    [[nodiscard]] int level(double value) const { return static_cast<int>(std::floor(value / step)); }
};

/// Some ten steps of 1, 2 or 5 times a power of ten.
Scale scale_of(double most) {
    if (!(most > 0) || !std::isfinite(most)) return {};
    constexpr double steps = 10;
    const double rough = most / steps, power = std::pow(10, std::floor(std::log10(rough)));
    double step = 10 * power;
    for (const double factor : {5.0, 2.0, 1.0})
        if (factor * power >= rough * (1 - 1e-9)) step = factor * power;
    return {step, step * std::ceil(most / step * (1 - 1e-9))};
}

std::string number(double value) {
    return fmt::format("{:.6g}", value);
}

/// Bilinear between the cells' middles; `at` in [0, 1]², v up.
double value_at(const GridReadings& grid, glm::dvec2 at) {
    const glm::ivec2 counts = grid.grid.counts;
    const glm::dvec2 place = glm::clamp(at * glm::dvec2(counts) - 0.5, glm::dvec2(0), glm::dvec2(counts - 1));
    const glm::ivec2 low = glm::min(glm::ivec2(place), glm::max(counts - 2, glm::ivec2(0)));
    const glm::dvec2 f = place - glm::dvec2(low);
    const auto reading = [&](int dx, int dy) {
        const glm::ivec2 cell = glm::min(low + glm::ivec2(dx, dy), counts - 1);
        return grid.readings[static_cast<std::size_t>(cell.y) * counts.x + cell.x].value;
    };
    return glm::mix(glm::mix(reading(0, 0), reading(1, 0), f.x), glm::mix(reading(0, 1), reading(1, 1), f.x), f.y);
}

glm::ivec2 plan_size(const SensorGrid& grid) {
    const glm::dvec2 sides(glm::length(grid.u), glm::length(grid.v));
    return glm::max(glm::ivec2(glm::round(sides * (plan_side / std::max(sides.x, sides.y)))), glm::ivec2(bar_width));
}

bool is_dark(const glm::vec3& display) {
    return display.x + display.y + display.z < 1.5f;
}

/// Where each iso-line passes, and its level.
struct IsoPixel {
    glm::ivec2 at;
    int level;
};

/// The plan at `corner`; returns the pixels of its iso-lines.
std::vector<IsoPixel> draw_plan(Image& image, glm::ivec2 corner, glm::ivec2 size, const GridReadings& grid, const Scale& scale) {
    std::vector<double> values(static_cast<std::size_t>(size.x) * size.y);
    const auto value = [&](int x, int y) -> double& { return values[static_cast<std::size_t>(y) * size.x + x]; };
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) value(x, y) = value_at(grid, {(x + 0.5) / size.x, 1 - (y + 0.5) / size.y});
    std::vector<IsoPixel> lines;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            glm::vec3 color = false_colour(value(x, y) / scale.top);
            const int here = scale.level(value(x, y)), right = scale.level(value(std::min(x + 1, size.x - 1), y)),
                      below = scale.level(value(x, std::min(y + 1, size.y - 1)));
            if (here != right || here != below) {
                color = is_dark(color) ? paper : ink;
                lines.push_back({corner + glm::ivec2(x, y), std::max({here, right, below})});
            }
            for (int c = 0; c < 3; ++c) image.at(corner.x + x, corner.y + y, c) = color[c];
        }
    return lines;
}

/// One number on each iso-line, where it is farthest from the numbers there are and from the border.
void label_lines(Image& image, glm::ivec2 corner, glm::ivec2 size, const std::vector<IsoPixel>& lines, const Scale& scale) {
    std::vector<glm::ivec2> taken;
    for (int level = 1; level < scale.levels(); ++level) {
        const std::string text = number(level * scale.step);
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
        const glm::vec3 color = false_colour(level * scale.step / scale.top);
        fill_rectangle(image, best - half, best + half, color);
        draw_text(image, best - half + 2, text, is_dark(color) ? paper : ink);
    }
}

void draw_legend(Image& image, glm::ivec2 corner, const Scale& scale) {
    draw_text(image, corner, "lx", ink);
    corner.y += text_size("lx").y + gap;
    for (int y = 0; y < bar_height; ++y)
        fill_rectangle(image, corner + glm::ivec2(0, y), corner + glm::ivec2(bar_width, y + 1), false_colour(1 - (y + 0.5) / bar_height));
    for (int level = 0; level <= scale.levels(); ++level) {
        const int y = corner.y + bar_height - static_cast<int>(std::lround(bar_height * level * scale.step / scale.top));
        const std::string text = number(level * scale.step);
        fill_rectangle(image, {corner.x + bar_width, y - 1}, {corner.x + bar_width + gap / 2, y + 1}, ink);
        draw_text(image, {corner.x + bar_width + gap, y - text_size(text).y / 2 + text_scale}, text, ink);
    }
}

/// What stands below a plan.
std::vector<std::string> caption(const GridReadings& grid) {
    double sum = 0, least = INFINITY, most = -INFINITY, half_width = 0;
    for (const SensorReading& reading : grid.readings) {
        sum += reading.value;
        least = std::min(least, reading.value);
        most = std::max(most, reading.value);
        half_width = std::max(half_width, reading.half_width_95);
    }
    const double mean = sum / static_cast<double>(grid.readings.size());
    return {fmt::format("{}: {:.3g} m x {:.3g} m, {} x {} points", grid.name, glm::length(grid.grid.u), glm::length(grid.grid.v),
                        grid.grid.counts.x, grid.grid.counts.y),
            fmt::format("mean {:.4g} lx, least {:.4g}, most {:.4g}, least/mean {:.2f}", mean, least, most, mean > 0 ? least / mean : 0),
            fmt::format("95 % half-width of a point at most {:.3g} lx", half_width)};
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

std::vector<GridReadings> grids_of(const Scene& scene, std::span<const SensorReading> readings) {
    std::vector<GridReadings> grids;
    std::size_t first = 0;
    scene.sensors().each([&](SensorId, const Sensor& sensor) {
        const std::size_t count = sensor.grid ? static_cast<std::size_t>(sensor.grid->counts.x) * sensor.grid->counts.y : 1;
        if (sensor.grid && first + count <= readings.size()) grids.push_back({sensor.name, *sensor.grid, readings.subspan(first, count)});
        first += count;
    });
    return grids;
}

Image draw_grids(std::span<const GridReadings> grids) {
    double most = 0;
    glm::ivec2 size(0, margin);
    const int line = text_size("lx").y + gap / 2;
    for (const GridReadings& grid : grids) {
        for (const SensorReading& reading : grid.readings) most = std::max(most, reading.value);
        const glm::ivec2 plan = plan_size(grid.grid);
        int text_width = 0, height = std::max(plan.y, bar_height + 2 * (line + gap)) + gap;
        for (const std::string& text : caption(grid)) {
            text_width = std::max(text_width, text_size(text).x);
            height += line;
        }
        size.x = std::max({size.x, plan.x, text_width});
        size.y += height + margin;
    }
    const Scale scale = scale_of(most);
    const int legend = bar_width + 2 * gap + text_size(number(scale.top)).x;
    Image image(size.x + legend + 3 * margin, size.y, 3, 1.0f);
    glm::ivec2 corner(margin);
    for (const GridReadings& grid : grids) {
        const glm::ivec2 plan = plan_size(grid.grid);
        const std::vector<IsoPixel> lines = draw_plan(image, corner, plan, grid, scale);
        label_lines(image, corner, plan, lines, scale);
        draw_legend(image, {image.width - margin - legend, corner.y}, scale);
        corner.y += std::max(plan.y, bar_height + 2 * (line + gap)) + gap;
        for (const std::string& text : caption(grid)) {
            draw_text(image, corner, text, ink);
            corner.y += line;
        }
        corner.y += margin;
    }
    return image;
}

}  // namespace heliodon::cli
