#include "import/luminaire.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "core/image_io.h"
#include "import/import.h"
#include "import/import_failure.h"
#include "import/import_model.h"

namespace heliodon {
namespace import {
namespace {

constexpr double degree = std::numbers::pi / 180;
// Files give angles with two or three decimals.
constexpr double same_angle_deg = 1e-3;

void mirror(std::vector<PhotometricPlane>& planes, double twice_the_axis_deg) {
    for (std::size_t i = 0, count = planes.size(); i < count; ++i) {
        PhotometricPlane other{twice_the_axis_deg - planes[i].azimuth_deg, planes[i].candela};
        if (other.azimuth_deg < -same_angle_deg) other.azimuth_deg += 360;
        planes.push_back(std::move(other));
    }
}

/// Ascending, each angle once, from 0 to 360.
void close_circle(std::vector<PhotometricPlane>& planes) {
    const auto earlier = [](const PhotometricPlane& a, const PhotometricPlane& b) { return a.azimuth_deg < b.azimuth_deg; };
    const auto same = [](const PhotometricPlane& a, const PhotometricPlane& b) {
        return b.azimuth_deg - a.azimuth_deg < same_angle_deg;
    };
    std::stable_sort(planes.begin(), planes.end(), earlier);
    planes.erase(std::unique(planes.begin(), planes.end(), same), planes.end());
    if (planes.size() > 1 && planes.back().azimuth_deg > 360 - same_angle_deg) planes.pop_back();
    if (planes.front().azimuth_deg > same_angle_deg) {  // on the way from the last to the first
        const PhotometricPlane &first = planes.front(), &last = planes.back();
        const double share = (360 - last.azimuth_deg) / (360 - last.azimuth_deg + first.azimuth_deg);
        PhotometricPlane between{0, first.candela};
        for (std::size_t i = 0; i < between.candela.size(); ++i)
            between.candela[i] = std::lerp(last.candela[i], first.candela[i], share);
        planes.insert(planes.begin(), std::move(between));
    }
    planes.push_back({360, planes.front().candela});
}

/// Nothing between 90° and 270°: the edges of the half-space fall to 0 at once.
void darken_behind(std::vector<PhotometricPlane>& planes) {
    const auto behind = std::find_if(planes.begin(), planes.end(), [](const auto& plane) { return plane.azimuth_deg > 180; });
    const auto at = behind - planes.begin();
    const std::vector<double> nothing(planes.front().candela.size(), 0.0);
    planes.insert(behind, {{planes[static_cast<std::size_t>(at) - 1].azimuth_deg, nothing},
                           {planes[static_cast<std::size_t>(at)].azimuth_deg, nothing}});
}

}  // namespace

std::optional<std::string> doubt_of_polar_angles(std::span<const double> polar_deg) {
    const auto is = [](double angle, double expected) { return std::abs(angle - expected) < same_angle_deg; };
    const double first = polar_deg.front(), last = polar_deg.back();
    if ((is(first, 0) && (is(last, 90) || is(last, 180))) || (is(first, 90) && is(last, 180))) return std::nullopt;
    return fmt::format("angles from nadir run from {:g} to {:g}: no light is sent outside them", first, last);
}

PhotometricWeb complete_web(std::span<const double> polar_deg, std::vector<PhotometricPlane> planes, PlaneSymmetry symmetry) {
    if (symmetry == PlaneSymmetry::mirrored_at_90_270 || symmetry == PlaneSymmetry::quadrants) mirror(planes, 180);
    if (symmetry == PlaneSymmetry::mirrored_at_0_180 || symmetry == PlaneSymmetry::quadrants) mirror(planes, 360);
    if (symmetry == PlaneSymmetry::all_round) {
        planes.resize(1);
        planes.front().azimuth_deg = 0;
    } else {
        close_circle(planes);
    }
    if (symmetry == PlaneSymmetry::half_space) darken_behind(planes);
    PhotometricWeb web;
    for (const double angle : polar_deg) web.polar_rad.push_back(angle * degree);
    for (const PhotometricPlane& plane : planes) {
        web.azimuth_rad.push_back(plane.azimuth_deg * degree);
        web.candela.insert(web.candela.end(), plane.candela.begin(), plane.candela.end());
    }
    return web;
}

namespace {

Luminaire read_by_content(const std::filesystem::path& path, int lamp_set, Warnings& warnings) {
    Result<std::string> bytes = read_file(path);
    if (!bytes) throw ImportFailure(bytes.error());
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    PhotometricText text(std::move(*bytes), path.string());
    // Every IES file has a TILT line and no EULUMDAT file.
    const auto is_tilt = [](std::string_view line) { return tilt_of(line).has_value(); };
    const bool is_ies = ending == ".ies" || std::any_of(text.lines().begin(), text.lines().end(), is_tilt);
    if (!is_ies) return read_eulumdat(text, lamp_set, warnings);
    if (lamp_set != 1) refuse(path.string(), "expected lamp_set 1: IES files have one set of lamps");
    return read_ies(text, path.parent_path(), warnings);
}

}  // namespace
NodeId import_luminaire(Scene& scene, NodeId parent, const std::filesystem::path& path, Warnings& warnings) {
    auto luminaire = std::make_shared<const Luminaire>(read_by_content(path, 1, warnings));
    Node node;
    node.name = path.stem().string();
    node.light = Light{.type = LightType::luminaire, .intensity = glm::vec3(static_cast<float>(luminaire->peak_cd))};
    node.light->luminaire = std::move(luminaire);
    return scene.add_node(std::move(node), parent);
}

}  // namespace import

Result<std::shared_ptr<const Luminaire>> load_luminaire(const std::filesystem::path& path, int lamp_set, Warnings& warnings) {
    return import::guarded(path, [&]() -> std::shared_ptr<const Luminaire> {
        return std::make_shared<const Luminaire>(import::read_by_content(path, lamp_set, warnings));
    });
}

}  // namespace heliodon
