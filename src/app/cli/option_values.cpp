#include "app/cli/option_values.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "scene/civil_time.h"
#include "scene/render_limits.h"

namespace heliodon::cli {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& expected, const std::string& found) {
    throw CLI::ValidationError(option, fmt::format("expected {}, found \"{}\"", expected, found));
}

template <class Number>
std::optional<Number> read_number(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

Engine read_engine(const std::string& text) {
    if (text == "realtime") return Engine::realtime;
    if (text == "path") return Engine::path;
    refuse("--engine", "realtime or path", text);
}

Integrator read_integrator(const std::string& text) {
    if (text == "path") return Integrator::path;
    if (text == "bidirectional") return Integrator::bidirectional;
    refuse("--integrator", "path or bidirectional", text);
}

Size read_size(const std::string& text) {
    constexpr int largest = 16384;  // a side that every Vulkan 1.3 device of note can render to
    const std::size_t x = text.find('x');
    if (x != std::string::npos) {
        const auto width = read_number<int>(std::string_view(text).substr(0, x));
        const auto height = read_number<int>(std::string_view(text).substr(x + 1));
        const auto fits = [](auto side) { return side && *side >= 1 && *side <= largest; };
        if (fits(width) && fits(height)) return {*width, *height};
    }
    refuse("--size", fmt::format("WIDTHxHEIGHT, each from 1 to {}", largest), text);
}

FrameRange read_frames(const std::string& text) {
    const std::size_t dots = text.find("..");
    if (dots != std::string::npos) {
        const auto first = read_number<int>(std::string_view(text).substr(0, dots));
        const auto last = read_number<int>(std::string_view(text).substr(dots + 2));
        if (first && last && *first >= 0 && *last >= *first) return {*first, *last};
    }
    refuse("--frames", "FIRST..LAST, whole numbers, FIRST not over LAST", text);
}

std::vector<std::string> read_aovs(const std::string& text) {
    static constexpr std::string_view known[] = {"albedo", "normal",   "depth", "position", "direct",
                                                 "indirect", "variance", "samples", "illuminance", "ao",
                                                 "voxels", "opacity"};
    std::vector<std::string> names = CLI::detail::split(text, ',');
    for (const std::string& name : names)
        if (std::find(std::begin(known), std::end(known), name) == std::end(known))
            refuse("--aov", fmt::format("names out of {}", fmt::join(known, ", ")), name);
    for (auto name = names.begin(); name != names.end(); ++name)
        if (std::find(names.begin(), name, *name) != name) refuse("--aov", "each name once", text);
    return names;
}

float read_ev100(const std::string& text) {
    const auto value = read_number<float>(text);
    if (!value || !std::isfinite(*value)) refuse("--ev100", "a number", text);
    return *value;
}

ToneCurve read_tone_curve(const std::string& text) {
    static constexpr std::pair<std::string_view, ToneCurve> curves[] = {
        {"linear", ToneCurve::linear}, {"hable", ToneCurve::hable},   {"reinhard", ToneCurve::reinhard},
        {"aces", ToneCurve::aces},     {"aces-narkowicz", ToneCurve::aces_narkowicz},
        {"agx", ToneCurve::agx},       {"neutral", ToneCurve::neutral}};
    for (const auto& [name, curve] : curves)
        if (text == name) return curve;
    refuse("--tonemap", "linear, hable, reinhard, aces, aces-narkowicz, agx or neutral", text);
}

FalseColourRange read_false_colour(const std::string& text) {
    std::vector<std::string> parts = CLI::detail::split(text, ':');
    FalseColourRange range;
    const auto ends_with = [&](const char* word) {
        if (parts.size() < 3 || parts.back() != word) return false;
        parts.pop_back();
        return true;
    };
    range.illuminance = ends_with("lux");
    range.logarithmic = ends_with("log");
    if (parts.size() == 2) {
        const auto low = read_number<double>(parts[0]), high = read_number<double>(parts[1]);
        if (low && high && std::isfinite(*high) && *low < *high && (range.logarithmic ? *low > 0 : *low >= 0)) {
            range.low = *low, range.high = *high;
            return range;
        }
    }
    refuse("--false-colour", "MIN:MAX in cd/m2, MIN below MAX and not below 0 (MIN:MAX:log: above 0), or in lux with :lux behind it", text);
}

TimeRange read_time_range(const std::string& text) {
    const std::size_t dots = text.find("..");
    if (dots == std::string::npos) refuse("--time-range", "FIRST..LAST, two moments as ISO 8601", text);
    const auto moment = [](const std::string& part) {
        const auto time = parse_civil_time(part, "--time-range");
        if (!time) throw CLI::ValidationError(time.error().text());
        return *time;
    };
    const TimeRange range{moment(text.substr(0, dots)), moment(text.substr(dots + 2))};
    if (range.last.unix_s < range.first.unix_s) refuse("--time-range", "FIRST not after LAST", text);
    return range;
}

double read_duration(const std::string& text) {
    static constexpr std::pair<std::string_view, double> units[] = {{"min", 60}, {"h", 3600}, {"d", 86400}, {"s", 1}};
    for (const auto& [unit, seconds] : units) {
        if (!text.ends_with(unit)) continue;
        const auto number = read_number<double>(std::string_view(text).substr(0, text.size() - unit.size()));
        if (number && std::isfinite(*number) && *number > 0) return *number * seconds;
    }
    refuse("--step", "a duration above 0 with its unit: 30s, 15min, 1h or 1d", text);
}

ProbedPixel read_pixel(const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma != std::string::npos) {
        const auto x = read_number<int>(std::string_view(text).substr(0, comma));
        const auto y = read_number<int>(std::string_view(text).substr(comma + 1));
        if (x && y && *x >= 0 && *y >= 0) return {*x, *y};
    }
    refuse("--probe", "X,Y of a pixel, from the top left corner", text);
}

std::string read_gi(const std::string& text) {
    if (text != "none" && text != "vct") refuse("--gi", "none or vct (the kinds that this version has)", text);
    return text;
}

int read_voxels(const std::string& text) {
    const auto voxels = read_number<int>(text);
    if (!voxels || *voxels < fewest_voxels || *voxels > most_voxels || !std::has_single_bit(unsigned(*voxels)))
        refuse("--voxels", fmt::format("a power of two from {} to {}", fewest_voxels, most_voxels), text);
    return *voxels;
}

bool is_voxel_aov(const std::string& name) {
    return name == "voxels" || name == "opacity";
}

bool is_path_aov(const std::string& name) {
    return name == "variance" || name == "samples";
}

std::string check_positive(const std::string& text) {
    const auto value = read_number<double>(text);
    return value && *value > 0 ? "" : fmt::format("expected a number above 0, found \"{}\"", text);
}

std::string check_not_negative(const std::string& text) {
    const auto value = read_number<double>(text);
    return value && *value >= 0 ? "" : fmt::format("expected a number at least 0, found \"{}\"", text);
}

std::string numbered_path(const std::string& path, int frame) {
    const std::size_t name = path.find_last_of('/') == std::string::npos ? 0 : path.find_last_of('/') + 1;
    const std::size_t first = path.find('#', name);
    if (first != std::string::npos) {
        const std::size_t end = std::min(path.find_first_not_of('#', first), path.size());
        return path.substr(0, first) + fmt::format("{:0{}}", frame, end - first) + path.substr(end);
    }
    const std::size_t ending = std::min(path.find_last_of('.'), path.size());
    const std::size_t at = ending < name ? path.size() : ending;
    return path.substr(0, at) + fmt::format("-{:04}", frame) + path.substr(at);
}

}  // namespace heliodon::cli
