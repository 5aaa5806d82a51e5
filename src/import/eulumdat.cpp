// EULUMDAT (*.ldt): Stockmar 1990, "EULUMDAT – ein Leuchtendatenformat für den europäischen Beleuchtungsplaner".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "import/luminaire.h"

namespace heliodon::import {
namespace {

constexpr double millimetre = 1e-3;
constexpr double same_angle_deg = 1e-2;
constexpr int most_angles = 10'000, most_lamp_sets = 1000;

enum class Symmetry { none = 0, about_axis = 1, c0_c180 = 2, c90_c270 = 3, both = 4 };

struct Declared {
    double downward_percent = 0, output_ratio_percent = 0, lamp_flux_lm = 0;
};

/// Dimensions of the luminous area: length lies along C90, width along C0; without a width it is round.
LuminousOpening read_opening(PhotometricText& text, std::vector<std::string>& doubts) {
    const auto dimension = [&](std::string_view what) {
        const double value = text.number_line(what, 0);
        if (value < 0) text.refuse(fmt::format("{} of at least 0", what), fmt::format("{}", value));
        return value * millimetre;
    };
    for (const char* what : {"the luminaire's length", "the luminaire's width", "the luminaire's height"})
        (void)dimension(what);
    const double length = dimension("the luminous area's length"), width = dimension("the luminous area's width");
    double lowest = 0, highest = 0;
    for (int side = 0; side < 4; ++side) {
        const double height = dimension("the luminous area's height");
        lowest = side == 0 ? height : std::min(lowest, height);
        highest = std::max(highest, height);
    }
    LuminousOpening opening;
    if (length == 0) {
        if (width > 0 || highest > 0) doubts.push_back("the luminous area has no length: it shines from a point");
        return opening;
    }
    if (lowest < highest)
        doubts.push_back(fmt::format("the luminous area's sides are {:g} to {:g} m high: all taken as the highest",
                                     lowest, highest));
    opening.shape = width == 0 ? OpeningShape::cylinder_y : OpeningShape::box;
    opening.size_m = glm::vec3(width == 0 ? length : width, highest, length);
    return opening;
}

/// The flux of the chosen set of lamps; each set has six lines.
double read_lamps(PhotometricText& text, int lamp_set, std::vector<std::string>& doubts) {
    const int sets = text.whole_line("the number of lamp sets", 0, most_lamp_sets);
    if (sets > 0 && lamp_set > sets)
        text.refuse(fmt::format("{0} sets of lamps, for lamp_set {0}", lamp_set), fmt::format("{}", sets));
    double flux = 0;
    for (int set = 1; set <= sets; ++set) {
        (void)text.number_line("the number of lamps", 1);  // below 0: absolute photometry, of the luminaire as it is
        (void)text.line("the type of lamps");
        const double lumen = text.number_line("the lamps' flux");
        if (set == lamp_set) flux = lumen;
        if (set == lamp_set && !(flux > 0)) text.refuse("a flux of lamps above 0", fmt::format("{}", flux));
        for (const char* what : {"the lamps' colour", "the lamps' colour rendering", "the lamps' power"})
            (void)text.line(what);
    }
    if (sets > 1) doubts.push_back(fmt::format("has {} sets of lamps: number {} is lit", sets, lamp_set));
    if (sets == 0) {
        constexpr double unit_flux_lm = 1000;
        doubts.push_back("names no lamps: taken with 1000 lm, which its intensities are for");
        return unit_flux_lm;
    }
    return flux;
}

std::size_t plane_count(Symmetry symmetry, std::size_t planes) {
    switch (symmetry) {
        case Symmetry::none:
            return planes;
        case Symmetry::about_axis:
            return 1;
        case Symmetry::c0_c180:
        case Symmetry::c90_c270:
            return planes / 2 + 1;
        case Symmetry::both:
            return planes / 4 + 1;
    }
    return planes;
}

PlaneSymmetry plane_symmetry(Symmetry symmetry) {
    switch (symmetry) {
        case Symmetry::none:
            return PlaneSymmetry::none;
        case Symmetry::about_axis:
            return PlaneSymmetry::all_round;
        case Symmetry::c0_c180:
            return PlaneSymmetry::mirrored_at_0_180;
        case Symmetry::c90_c270:
            return PlaneSymmetry::mirrored_at_90_270;
        case Symmetry::both:
            return PlaneSymmetry::quadrants;
    }
    return PlaneSymmetry::none;
}

void check_rising(const PhotometricText& text, std::string_view what, std::span<const double> angles, double high) {
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (angles[i] < 0 || angles[i] > high)
            text.refuse(fmt::format("{} angles from 0 to {}", what, high), fmt::format("{}", angles[i]));
        if (i > 0 && !(angles[i] > angles[i - 1]))
            text.refuse(fmt::format("{} angles that rise", what), fmt::format("{} after {}", angles[i], angles[i - 1]));
    }
}

/// The angles of the planes that the file gives intensities for; those symmetric to C90–C270 begin at C270.
std::vector<double> given_planes(const PhotometricText& text, Symmetry symmetry, const std::vector<double>& c_deg) {
    const std::size_t all = c_deg.size(), count = plane_count(symmetry, all);
    const auto require = [&](std::size_t index, double angle) {
        if (index < all && std::abs(c_deg[index] - angle) < same_angle_deg) return;
        text.refuse(
            fmt::format("C{} as plane {} of {} (symmetry {})", angle, index + 1, all, static_cast<int>(symmetry)),
            index < all ? fmt::format("C{}", c_deg[index]) : std::string("none"));
    };
    require(0, symmetry == Symmetry::about_axis ? c_deg.front() : 0);
    std::size_t first = 0;
    if (symmetry == Symmetry::c0_c180) require(count - 1, 180);
    if (symmetry == Symmetry::both) require(count - 1, 90);
    if (symmetry == Symmetry::c90_c270) {
        first = 3 * all / 4;
        require(first, 270);
        require((first + count - 1) % all, 90);
    }
    std::vector<double> planes;
    for (std::size_t i = 0; i < count; ++i) planes.push_back(c_deg[(first + i) % all]);
    return planes;
}

void warn_of_ratios(const Declared& declared, const Luminaire& luminaire, std::vector<std::string>& doubts) {
    // Photometers and the steps of the angles are good to a few per cent (CIE S 025, 5).
    constexpr double tolerance = 0.05;
    const double ratio = 100 * luminaire.flux_lm / declared.lamp_flux_lm;
    if (declared.output_ratio_percent > 0 &&
        std::abs(ratio - declared.output_ratio_percent) > tolerance * declared.output_ratio_percent)
        doubts.push_back(
            fmt::format("declares a light output ratio of {:g} %, its intensities make {:.1f} % of the lamps' {:g} lm",
                        declared.output_ratio_percent, ratio, declared.lamp_flux_lm));
    const double down = luminaire.flux_lm > 0
                            ? 100 * integrated_flux_lm(luminaire.web, 0, std::numbers::pi / 2) / luminaire.flux_lm
                            : declared.downward_percent;
    if (declared.downward_percent > 0 && std::abs(down - declared.downward_percent) > 100 * tolerance)
        doubts.push_back(fmt::format("declares {:g} % of its light downwards, its intensities send {:.1f} % there",
                                     declared.downward_percent, down));
    if (!(luminaire.peak_cd > 0)) doubts.push_back("all intensities are 0");
}

void read_web(PhotometricText& text, Symmetry symmetry, int c_count, int g_count, double candela_a_value,
              Luminaire& luminaire, std::vector<std::string>& doubts) {
    constexpr int direct_ratios = 10;
    for (int i = 0; i < direct_ratios; ++i) (void)text.number_line("a direct ratio", 0);
    const std::vector<double> c_deg = text.numbers("C-plane", static_cast<std::size_t>(c_count), true);
    check_rising(text, "C", c_deg, 360);
    const std::vector<double> planes_deg = given_planes(text, symmetry, c_deg);
    const std::vector<double> g_deg = text.numbers("angle", static_cast<std::size_t>(g_count), true);
    check_rising(text, "gamma", g_deg, 180);
    if (auto doubt = doubt_of_polar_angles(g_deg)) doubts.push_back(*std::move(doubt));
    const std::vector<double> values = text.numbers("intensity", planes_deg.size() * g_deg.size(), true);
    const auto negative = std::count_if(values.begin(), values.end(), [](double value) { return value < 0; });
    if (negative > 0) doubts.push_back(fmt::format("{} intensities are negative: taken as 0", negative));
    std::vector<PhotometricPlane> planes;
    for (std::size_t i = 0; i < planes_deg.size(); ++i) {
        PhotometricPlane plane{planes_deg[i], {}};
        for (std::size_t k = 0; k < g_deg.size(); ++k)
            plane.candela.push_back(std::max(values[i * g_deg.size() + k], 0.0) * candela_a_value);
        planes.push_back(std::move(plane));
    }
    luminaire.web = complete_web(g_deg, std::move(planes), plane_symmetry(symmetry));
    if (text.has_words()) doubts.push_back("more follows after the last intensity: not read");
}

}  // namespace

Luminaire read_eulumdat(PhotometricText& text, int lamp_set, Warnings& warnings) {
    std::vector<std::string> doubts;
    Luminaire luminaire;
    (void)text.line("the manufacturer");
    (void)text.whole_line("the type of the light source", 0, 3, 1);
    const auto symmetry = static_cast<Symmetry>(text.whole_line("the symmetry", 0, 4));
    const int c_count = text.whole_line("the number of C-planes", 1, most_angles);
    (void)text.number_line("the distance between C-planes", 0);
    const int g_count = text.whole_line("the number of angles in a plane", 2, most_angles);
    (void)text.number_line("the distance between angles", 0);
    (void)text.line("the report's number");
    luminaire.name = text.line("the luminaire's name");
    for (const char* what : {"the luminaire's number", "the file's name", "the date"}) (void)text.line(what);
    luminaire.opening = read_opening(text, doubts);
    Declared declared;
    declared.downward_percent = text.number_line("the downward flux fraction", 0);
    declared.output_ratio_percent = text.number_line("the light output ratio", 0);
    const double conversion = text.number_line("the conversion factor of intensities", 1);
    if (!(conversion > 0)) text.refuse("a conversion factor of intensities above 0", fmt::format("{}", conversion));
    (void)text.number_line("the tilt of the luminaire when measured", 0);
    declared.lamp_flux_lm = read_lamps(text, lamp_set, doubts);
    // Intensities are in cd for each 1000 lm of the lamps.
    read_web(text, symmetry, c_count, g_count, conversion * declared.lamp_flux_lm / 1000, luminaire, doubts);
    integrate(luminaire);
    warn_of_ratios(declared, luminaire, doubts);
    for (std::string& doubt : doubts) warnings.push_back({text.name(), std::move(doubt)});
    return luminaire;
}

}  // namespace heliodon::import
