#include "app/cli/false_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/cli/bitmap_text.h"
#include "app/cli/false_colour_plan.h"
#include "core/units.h"

namespace heliodon::cli {
namespace {

constexpr int plan_side = 720, margin = 24, gap = 12, least_side = 32;
constexpr glm::vec3 ink(0);

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
    return glm::max(glm::ivec2(glm::round(sides * (plan_side / std::max(sides.x, sides.y)))), glm::ivec2(least_side));
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
    for (const GridReadings& grid : grids)
        for (const SensorReading& reading : grid.readings) most = std::max(most, reading.value);
    const IsoScale scale = IsoScale::from_zero(most);
    const glm::ivec2 legend = legend_size(scale);
    const int line = text_size("lx").y + gap / 2;
    glm::ivec2 size(0, margin);
    for (const GridReadings& grid : grids) {
        const glm::ivec2 plan = plan_size(grid.grid);
        int text_width = 0, height = std::max(plan.y, legend.y) + gap;
        for (const std::string& text : caption(grid)) {
            text_width = std::max(text_width, text_size(text).x);
            height += line;
        }
        size.x = std::max({size.x, plan.x, text_width});
        size.y += height + margin;
    }
    Image image(size.x + legend.x + 3 * margin, size.y, 3, 1.0f);
    glm::ivec2 corner(margin);
    for (const GridReadings& grid : grids) {
        const glm::ivec2 plan = plan_size(grid.grid);
        const auto value = [&](int x, int y) { return value_at(grid, {(x + 0.5) / plan.x, 1 - (y + 0.5) / plan.y}); };
        draw_plan(image, corner, plan, value, scale);
        draw_legend(image, {image.width - margin - legend.x, corner.y}, "lx", scale);
        corner.y += std::max(plan.y, legend.y) + gap;
        for (const std::string& text : caption(grid)) {
            draw_text(image, corner, text, ink);
            corner.y += line;
        }
        corner.y += margin;
    }
    return image;
}

Image draw_in_false_colour(const Image& light, const IsoScale& scale, const std::string& unit) {
    const glm::ivec2 legend = legend_size(scale), picture(light.width, light.height);
    Image image(picture.x + legend.x + 2 * margin, std::max(picture.y, legend.y + 2 * margin), 3, 1.0f);
    draw_plan(image, glm::ivec2(0), picture, [&](int x, int y) { return units::luminance(light.rgb(x, y)); }, scale);
    draw_legend(image, {picture.x + margin, margin}, unit, scale);
    return image;
}

}  // namespace heliodon::cli
