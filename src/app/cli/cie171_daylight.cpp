// CIE 171:2006, tests 5.9 to 5.14: daylight in a black room 4 × 4 × 3 m through a hole in its roof or facade, clear or
// glazed, below an overhang or behind a wall, under the skies of ISO 15469 with the sun at 60°, whose own light is left out.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/cli/cie171_exact.h"
#include "app/cli/cie171_scene.h"
#include "convert/pack.h"
#include "shading/cie_sky.h"
#include "shading/sky.h"

namespace heliodon::cli {
namespace {

constexpr double room_height = 3;
constexpr int skies[] = {1, 2, 3, 5, 6, 9, 10, 12, 14, Sky::traditional_overcast};  // those of the report

/// Part of the scene outside.
struct Outside {
    double overhang = 0;    ///< m: how far a black roof reaches out at the height of the room's ceiling
    bool far_wall = false;  ///< black, 3 m high, 6 m before the facade
};
constexpr double far_wall_distance = 6, far_wall_height = 3;

/// A hole across [low, high] of a wall (its x and z) or of the roof (x and y).
struct Opening {
    glm::dvec2 low{0}, high{0};
    [[nodiscard]] std::string name() const { return fmt::format("{:g}×{:g} m", high.x - low.x, high.y - low.y); }
};

struct Case {
    bool roof = false;
    Opening opening;
    bool glazed = false;
    Outside outside;
    int sky = 1;
};

/// Towards the sun wall A–F looks (roof), or it stands before the facade.
Sky sky_of(const Case& c) {
    Sky sky;
    sky.model = SkyModel::cie;
    sky.cie_type = c.sky;
    sky.zenith_luminance_nits = 1000;
    sky.ground_albedo = 0.3f;
    sky.sun_elevation_rad = static_cast<float>(std::numbers::pi / 3);
    sky.sun_azimuth_rad = c.roof ? std::numbers::pi_v<float> : 0.0f;
    return sky;
}

/// A wall with a hole, in its own coordinates: `at(0, 0)` to `at(size)`.
void add_wall_with_hole(Scene& scene, const glm::dvec3& origin, const glm::dvec3& s, const glm::dvec3& t, glm::dvec2 size,
                        const Opening& hole) {
    const auto add = [&](double s0, double t0, double s1, double t1) {
        if (s1 > s0 && t1 > t0) add_quad(scene, origin + s0 * s + t0 * t, (s1 - s0) * s, (t1 - t0) * t, black());
    };
    add(0, 0, hole.low.x, size.y);
    add(hole.high.x, 0, size.x, size.y);
    add(hole.low.x, 0, hole.high.x, hole.low.y);
    add(hole.low.x, hole.high.y, hole.high.x, size.y);
}

void add_room(Scene& scene, const Case& c) {
    const glm::dvec3 x = room(1, 0, 0), y = room(0, 1, 0), z = room(0, 0, 1);
    const Opening none;
    add_wall_with_hole(scene, {}, x, y, {4, 4}, none);
    add_wall_with_hole(scene, room_height * z, x, y, {4, 4}, c.roof ? c.opening : none);
    add_wall_with_hole(scene, {}, x, z, {4, room_height}, c.roof ? none : c.opening);
    add_wall_with_hole(scene, 4.0 * y, x, z, {4, room_height}, none);
    add_wall_with_hole(scene, {}, y, z, {4, room_height}, none);
    add_wall_with_hole(scene, 4.0 * x, y, z, {4, room_height}, none);
    if (c.glazed) {
        const glm::dvec3 t = c.roof ? y : z, origin = c.roof ? room_height * z : glm::dvec3(0);
        const glm::dvec2 size = c.opening.high - c.opening.low;
        add_quad(scene, origin + c.opening.low.x * x + c.opening.low.y * t, size.x * x, size.y * t, clear_glass_pane());
    }
    constexpr double wide = 100;  // nothing farther aside can be seen from inside
    if (c.outside.overhang > 0)
        add_quad(scene, room(-wide, -c.outside.overhang, room_height), room(2 * wide, 0, 0), c.outside.overhang * y, black());
    if (c.outside.far_wall)
        add_quad(scene, room(-wide, -far_wall_distance, 0), room(2 * wide, 0, 0), room(0, 0, far_wall_height), black());
}

/// What a point receives by quadrature over the opening.
class Exact {
public:
    Exact(const Case& c, const shading::SkyData& sky) : case_(c), sky_(sky) {}

    [[nodiscard]] double operator()(const glm::dvec3& position, const glm::dvec3& normal) const {
        const glm::dvec2 low = case_.opening.low, size = case_.opening.high - low;
        Aperture aperture;
        aperture.corner = case_.roof ? room(low.x, low.y, room_height) : room(low.x, 0, low.y);
        aperture.u = room(size.x, 0, 0);
        aperture.v = case_.roof ? room(0, size.y, 0) : room(0, 0, size.y);
        if (!case_.roof) {
            const double height = position.y, depth = position.z;
            const auto break_at = [&](double edge_height, double edge_distance) {
                const double z = height + (edge_height - height) * depth / (depth + edge_distance);
                aperture.breaks.push_back((z - low.y) / size.y);
            };
            aperture.breaks.push_back((height - low.y) / size.y);
            if (case_.outside.overhang > 0) break_at(room_height, case_.outside.overhang);
            if (case_.outside.far_wall) {
                break_at(far_wall_height, far_wall_distance);
                break_at(0, far_wall_distance);
            }
        }
        const auto glass = case_.glazed ? Transmittance(clear_glass_transmittance) : Transmittance();
        return illuminance_through(aperture, position, normal,
                                   [&](const glm::dvec3& direction) { return seen(position, direction); }, glass);
    }

private:
    [[nodiscard]] double seen(const glm::dvec3& position, const glm::dvec3& direction) const {
        const double depth = position.z, height = position.y;
        if (case_.outside.overhang > 0 && direction.y > 0) {
            const double at = depth + (room_height - height) / direction.y * direction.z;
            if (at < 0 && at > -case_.outside.overhang) return 0;
        }
        if (case_.outside.far_wall && direction.z < 0) {
            const double at = height + (depth + far_wall_distance) / -direction.z * direction.y;
            if (at > 0 && at < far_wall_height) return 0;
        }
        return shading::sky_radiance(sky_, glm::vec3(direction), glm::vec3(1)).x;
    }

    Case case_;
    shading::SkyData sky_;
};

CieScene build(const std::string& test, const Case& c, bool walls, bool ceiling) {
    CieScene result;
    result.test = test;
    result.variant = fmt::format("{}, sky {}", c.opening.name(), c.sky);
    if (c.outside.overhang > 0) result.variant = fmt::format("overhang {:g} m, sky {}", c.outside.overhang, c.sky);
    if (c.outside.far_wall) result.variant = fmt::format("wall opposite, sky {}", c.sky);
    result.unit = "% of E_hz";
    result.scene.set_sky(sky_of(c));
    add_room(result.scene, c);
    const shading::SkyData sky = convert::pack_sky(result.scene);
    result.scale = 100 / shading::horizontal_illuminance(sky);
    result.floor = 0.05;
    const Exact exact(c, sky);
    const auto add = [&](const std::string& name, const glm::dvec3& position, const glm::dvec3& normal) {
        add_point(result, name, position, normal, result.scale * exact(position, normal));
    };
    // Off the wall that stands under the hole's side (roof), or off the one opposite the facade.
    const auto off = [&](double distance) { return c.roof ? distance : 4 - distance; };
    for (int i = 0; walls && i < 6; ++i)
        add(std::string(1, "ABCDEF"[i]), room(2, off(0), 2.75 - 0.5 * i), room(0, c.roof ? 1 : -1, 0));
    for (int i = 0; i < 8; ++i) add(std::string(1, (walls ? "GHIJKLMN" : "ABCDEFGH")[i]), room(2, off(0.25 + 0.5 * i), 0), room(0, 0, 1));
    for (int i = 0; ceiling && i < 8; ++i)
        add(fmt::format("ceiling, y {:g}", off(0.25 + 0.5 * i)), room(2, off(0.25 + 0.5 * i), room_height), room(0, 0, -1));
    return result;
}

}  // namespace

std::vector<CieScene> cie_daylight_scenes(const std::string& test) {
    const Opening small_roof{{1.5, 1.5}, {2.5, 2.5}}, whole_roof{{0, 0}, {4, 4}}, window{{1, 1}, {3, 2}}, facade{{0, 0}, {4, 3}};
    const bool glazed = test == "5.10" || test == "5.12";
    std::vector<Case> cases;
    if (test == "5.9" || test == "5.10")
        for (const Opening& opening : {small_roof, whole_roof}) cases.push_back({true, opening, glazed, {}});
    if (test == "5.11" || test == "5.12")
        for (const Opening& opening : {window, facade}) cases.push_back({false, opening, glazed, {}});
    if (test == "5.13")
        for (const double depth : {0.5, 1.0, 2.0}) cases.push_back({false, window, false, {.overhang = depth}});
    if (test == "5.14") cases.push_back({false, window, false, {.far_wall = true}});
    std::vector<CieScene> scenes;
    for (Case c : cases)
        for (const int sky : skies) {
            c.sky = sky;
            const bool obstructed = test == "5.13" || test == "5.14";
            // The ceiling sees the ground alone, which is the same under every sky.
            scenes.push_back(build(test, c, !obstructed, !c.roof && !obstructed && sky == skies[0]));
        }
    return scenes;
}

}  // namespace heliodon::cli
