// ANSI/IES LM-63: 1986, 1991, 1995, 2002 and 2019.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>

#include "core/image_io.h"
#include "import/import_failure.h"
#include "import/luminaire.h"

namespace heliodon::import {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double metres_a_foot = 0.3048;
constexpr double same_angle_deg = 1e-3;
constexpr int most_angles = 100'000;

std::string upper(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return result;
}

/// Type of photometry: how the angles of a direction are counted (LM-63-2002, section 3).
enum class PhotometryType { c = 1, b = 2, a = 3 };

struct Header {
    int year = 1986;  ///< of the standard; files of the first had no line that says so
    std::map<std::string, std::string> keywords;
    std::string tilt;
};

int year_of(std::string_view first_line) {
    const std::string line = upper(first_line);
    for (const int year : {2019, 2002, 1995, 1991, 1986})
        if (line.find(fmt::format("LM-63-{}", year)) != std::string::npos) return year;
    if (line.starts_with("IESNA91")) return 1991;
    if (line.find("LM-63-91") != std::string::npos) return 1991;
    if (line.find("LM-63-95") != std::string::npos) return 1995;
    if (line.find("LM-63-02") != std::string::npos) return 2002;
    if (line.find("LM-63-19") != std::string::npos) return 2019;
    return 1986;
}

Header read_header(PhotometricText& text) {
    Header header;
    bool first = true;
    while (true) {
        const std::string_view line = text.line("a line that begins with TILT=");
        if (const auto tilt = tilt_of(line)) {
            header.tilt = *tilt;
            return header;
        }
        if (first) header.year = year_of(line);
        first = false;
        const std::size_t end = line.find(']');
        if (!line.starts_with('[') || end == std::string_view::npos) continue;
        std::string value(line.substr(end + 1));
        value.erase(0, std::min(value.find_first_not_of(' '), value.size()));
        header.keywords.try_emplace(upper(line.substr(1, end - 1)), std::move(value));
    }
}

/// The lamp's position in the luminaire (1 to 3) goes unused: each file's factors are for its own.
void read_tilt(PhotometricText& text, Luminaire& luminaire) {
    (void)text.whole("the lamp's geometry", 1, 3);
    const int count = text.whole("the count of tilt angles", 1, most_angles);
    for (const double angle : text.numbers("tilt angle", static_cast<std::size_t>(count), false)) {
        if (!luminaire.tilt_rad.empty() && !(angle * degree > luminaire.tilt_rad.back()))
            text.refuse("tilt angles that rise", fmt::format("{}", angle));
        luminaire.tilt_rad.push_back(angle * degree);
    }
    luminaire.tilt_factor = text.numbers("tilt factor", luminaire.tilt_rad.size(), false);
    for (const double factor : luminaire.tilt_factor)
        if (factor < 0) text.refuse("a tilt factor of at least 0", fmt::format("{}", factor));
}

void read_tilt_file(const std::string& file, const PhotometricText& text, const std::filesystem::path& folder,
                    Luminaire& luminaire) {
    if (file.empty() || file.find('\0') != std::string::npos)
        text.refuse("TILT=NONE, TILT=INCLUDE or TILT=FILE", "no file");
    const std::filesystem::path path = folder / file;
    Result<std::string> bytes = read_file(path);
    if (!bytes) refuse(text.where(), bytes.error().text());
    PhotometricText tilt(std::move(*bytes), path.string());
    read_tilt(tilt, luminaire);
}

/// Dimensions as each standard codes them: negative ones are diameters of something round (LM-63-2002, table 1), which
/// 1995 and before wrote with one diameter alone. Length lies along C0, width across, height upwards.
LuminousOpening opening_of(double width, double length, double height, int year, std::vector<std::string>& doubts) {
    // A lone diameter: a circle, an upright cylinder (height above 0), and before 2002 a sphere (height below 0).
    if (width < 0 && length == 0 && (year < 2002 || height >= 0)) length = width;
    if (length < 0 && width == 0 && height >= 0) width = length;
    // Lying cylinders before 2002: (0, L, −D) and (W, 0, −D).
    if (height < 0 && width == 0 && length > 0) width = height;
    if (height < 0 && length == 0 && width > 0) length = height;
    LuminousOpening opening;
    opening.size_m = glm::vec3(std::abs(length), std::abs(height), std::abs(width));
    const int zeros = (width == 0) + (length == 0) + (height == 0);
    const int round = (width < 0) + (length < 0) + (height < 0);
    if (zeros >= 2) {
        if (zeros == 2) doubts.push_back("the luminous opening is a line, without an area: it shines from a point");
        opening.size_m = {};
        return opening;
    }
    if (round == 0)
        opening.shape = OpeningShape::box;
    else if (round == 3)
        opening.shape = OpeningShape::ellipsoid;
    else if (round == 2)
        opening.shape = width >= 0    ? OpeningShape::cylinder_z
                        : length >= 0 ? OpeningShape::cylinder_x
                                      : OpeningShape::cylinder_y;
    else if (height >= 0)
        opening.shape = OpeningShape::cylinder_y;  // (−W, L, …): an ellipse before 2002
    else {
        opening.shape = OpeningShape::box;
        doubts.push_back("no standard gives the luminous opening a negative height alone: taken as a box");
    }
    return opening;
}

struct Angles {
    std::vector<double> vertical_deg, horizontal_deg;
    PlaneSymmetry symmetry = PlaneSymmetry::none;
};

bool near(double a, double b) {
    return std::abs(a - b) < same_angle_deg;
}

void check_rising(const PhotometricText& text, std::string_view what, std::span<const double> angles, double low,
                  double high) {
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (angles[i] < low - same_angle_deg || angles[i] > high + same_angle_deg)
            text.refuse(fmt::format("{} angles from {} to {}", what, low, high), fmt::format("{}", angles[i]));
        if (i > 0 && !(angles[i] > angles[i - 1]))
            text.refuse(fmt::format("{} angles that rise", what), fmt::format("{} after {}", angles[i], angles[i - 1]));
    }
}

/// LM-63-2002, section 5.13: what the last horizontal angle says.
PlaneSymmetry symmetry_of_type_c(const PhotometricText& text, std::vector<double>& horizontal,
                                 std::vector<std::string>& doubts) {
    if (horizontal.size() == 1) return PlaneSymmetry::all_round;
    const double first = horizontal.front(), last = horizontal.back();
    if (near(first, 90) && near(last, 270)) return PlaneSymmetry::mirrored_at_90_270;
    if (!near(first, 0))
        text.refuse("horizontal angles that begin at 0, or run from 90 to 270", fmt::format("{} to {}", first, last));
    if (near(last, 90)) return PlaneSymmetry::quadrants;
    if (near(last, 180)) return PlaneSymmetry::mirrored_at_0_180;
    if (near(last, 360)) return PlaneSymmetry::none;
    const double step = last - horizontal[horizontal.size() - 2];
    if (!(last > 180 && last + step > 360 - same_angle_deg))
        text.refuse("horizontal angles that end at 0, 90, 180 or 360", fmt::format("{}", last));
    doubts.push_back(fmt::format("horizontal angles end at {}: the plane at 0 closes the circle", last));
    return PlaneSymmetry::none;
}

Angles read_angles(PhotometricText& text, PhotometryType type, int vertical, int horizontal,
                   std::vector<std::string>& doubts) {
    Angles angles;
    angles.vertical_deg = text.numbers("vertical angle", static_cast<std::size_t>(vertical), false);
    const bool is_c = type == PhotometryType::c;
    check_rising(text, "vertical", angles.vertical_deg, is_c ? 0 : -90, is_c ? 180 : 90);
    angles.horizontal_deg = text.numbers("horizontal angle", static_cast<std::size_t>(horizontal), false);
    check_rising(text, "horizontal", angles.horizontal_deg, is_c ? 0 : -90, is_c ? 360 : 90);
    if (is_c) {
        if (auto doubt = doubt_of_polar_angles(angles.vertical_deg)) doubts.push_back(*std::move(doubt));
        angles.symmetry = symmetry_of_type_c(text, angles.horizontal_deg, doubts);
        return angles;
    }
    const double first = angles.horizontal_deg.front(), last = angles.horizontal_deg.back();
    if (!near(last, 90) || !(near(first, 0) || near(first, -90)))
        text.refuse("horizontal angles from 0 or -90 to 90 (type A or B)", fmt::format("{} to {}", first, last));
    angles.symmetry = PlaneSymmetry::half_space;
    return angles;
}

/// Types A and B count their angles the other way round, from a vertical angle of −90 at polar angle 0.
void turn_half_space(std::vector<PhotometricPlane>& planes, std::vector<double>& vertical_deg) {
    for (double& angle : vertical_deg) angle += 90;
    const bool mirrored = near(planes.front().azimuth_deg, 0);
    const std::size_t count = planes.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = planes[i].azimuth_deg;
        if (mirrored && angle > same_angle_deg) planes.push_back(planes[i]);
        planes[i].azimuth_deg = angle > same_angle_deg ? 360 - angle : -angle;
    }
}

struct Data {
    int lamps = 1;
    double lumens_a_lamp = -1, multiplier = 1;
    PhotometryType type = PhotometryType::c;
    double factor = 1;  ///< of ballasts and lamps
};

void warn_of_flux(const Data& data, const Luminaire& luminaire, std::vector<std::string>& doubts) {
    // No luminaire gives more than its lamps do; goniophotometers agree to a few per cent (CIE S 025, 5).
    constexpr double tolerance = 0.05;
    const double lamps = data.lamps * data.lumens_a_lamp * data.factor;
    if (data.lumens_a_lamp > 0 && luminaire.flux_lm > lamps * (1 + tolerance))
        doubts.push_back(
            fmt::format("the intensities make {:.1f} lm, more than the {:.1f} lm that the lamps are said to give",
                        luminaire.flux_lm, lamps));
    if (!(luminaire.peak_cd > 0)) doubts.push_back("all intensities are 0");
}

void read_web(PhotometricText& text, const Data& data, int vertical, int horizontal, Luminaire& luminaire,
              std::vector<std::string>& doubts) {
    Angles angles = read_angles(text, data.type, vertical, horizontal, doubts);
    const std::size_t rows = angles.vertical_deg.size(), count = rows * angles.horizontal_deg.size();
    std::vector<double> values = text.numbers("intensity", count, false);
    const auto negative = std::count_if(values.begin(), values.end(), [](double value) { return value < 0; });
    if (negative > 0) doubts.push_back(fmt::format("{} intensities are negative: taken as 0", negative));
    std::vector<PhotometricPlane> planes;
    for (std::size_t i = 0; i < angles.horizontal_deg.size(); ++i) {
        PhotometricPlane plane{angles.horizontal_deg[i], {}};
        for (std::size_t k = 0; k < rows; ++k)
            plane.candela.push_back(std::max(values[i * rows + k], 0.0) * data.multiplier * data.factor);
        planes.push_back(std::move(plane));
    }
    if (data.type != PhotometryType::c) turn_half_space(planes, angles.vertical_deg);
    luminaire.web = complete_web(angles.vertical_deg, std::move(planes), angles.symmetry);
    if (data.type == PhotometryType::b) luminaire.web.axis = PhotometricWeb::Axis::horizontal;
    if (text.has_words()) doubts.push_back("more follows after the last intensity: not read");
}

}  // namespace

std::optional<std::string_view> tilt_of(std::string_view line) {
    if (upper(line.substr(0, 4)) != "TILT") return std::nullopt;
    line.remove_prefix(4);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (!line.starts_with('=')) return std::nullopt;
    line.remove_prefix(1);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    return line;
}

Luminaire read_ies(PhotometricText& text, const std::filesystem::path& folder, Warnings& warnings) {
    const Header header = read_header(text);
    Luminaire luminaire;
    const auto named = header.keywords.find("LUMINAIRE");
    luminaire.name = named != header.keywords.end() ? named->second : std::string();
    std::vector<std::string> doubts;
    const std::string tilt = upper(header.tilt);
    if (tilt == "INCLUDE")
        read_tilt(text, luminaire);
    else if (tilt != "NONE")
        read_tilt_file(header.tilt, text, folder, luminaire);

    Data data;
    data.lamps = text.whole("the number of lamps", 0, most_angles);
    data.lumens_a_lamp = text.number("the lumens of a lamp");
    data.multiplier = text.number("the multiplier of intensities");
    if (!(data.multiplier > 0)) text.refuse("a multiplier of intensities above 0", fmt::format("{}", data.multiplier));
    const int vertical = text.whole("the count of vertical angles", 2, most_angles);
    const int horizontal = text.whole("the count of horizontal angles", 1, most_angles);
    data.type = static_cast<PhotometryType>(text.whole("the type of photometry", 1, 3));
    const double unit_m = text.whole("the unit of length", 1, 2) == 1 ? metres_a_foot : 1;
    const double width = text.number("the width of the opening") * unit_m;
    const double length = text.number("the length of the opening") * unit_m;
    const double height = text.number("the height of the opening") * unit_m;
    luminaire.opening = opening_of(width, length, height, header.year, doubts);
    const double ballast = text.number("the ballast factor"),
                 other = text.number("the ballast-lamp photometric factor");
    (void)text.number("the input watts");
    // The second factor went out of use in 2002; since 2019 its place says how the file was made.
    data.factor = ballast * (header.year < 2002 ? other : 1.0);
    if (!(data.factor > 0)) text.refuse("a ballast factor above 0", fmt::format("{}", data.factor));
    read_web(text, data, vertical, horizontal, luminaire, doubts);
    integrate(luminaire);
    warn_of_flux(data, luminaire, doubts);
    for (std::string& doubt : doubts) warnings.push_back({text.name(), std::move(doubt)});
    return luminaire;
}

}  // namespace heliodon::import
