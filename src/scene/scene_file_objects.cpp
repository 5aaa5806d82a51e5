// Shapes and lights.
#include <fmt/format.h>

#include <limits>

#include "core/units.h"
#include "scene/procedural.h"
#include "scene/scene_file_parts.h"

namespace heliodon::scene_file {
namespace {

Quad read_quad(ObjectReader& object) {
    const Quad quad{object.require("origin").vector(), object.require("u").vector(), object.require("v").vector()};
    const glm::vec3 normal = glm::cross(quad.u, quad.v);
    const float area = glm::length(normal);
    if (!(area > 0 && area <= std::numeric_limits<float>::max()))
        throw Refusal{object.cursor().path(), fmt::format("expected u and v that span an area, found {} m²", area)};
    return quad;
}

Disk read_disk(ObjectReader& object) {
    return {object.require("center").vector(), object.require("normal").unit_vector(),
            object.require("radius").number(positive)};
}

Box read_box(ObjectReader& object) {
    const Box box{object.require("min").vector(), object.require("max").vector()};
    if (!glm::all(glm::lessThan(box.min, box.max)))
        throw Refusal{object.cursor().path() + ".max",
                      "expected a corner above min on every axis, found one that is not"};
    return box;
}

Sphere read_sphere(ObjectReader& object) {
    return {object.require("center").vector(), object.require("radius").number(positive)};
}

Mesh read_teapot(ObjectReader& object) {
    constexpr int most_subdivisions = 256;
    int subdivisions = 10;
    object.read("subdivisions", subdivisions, 1, most_subdivisions);
    return teapot_mesh(subdivisions);
}

Mesh read_torus_knot(ObjectReader& object) {
    constexpr int most_windings = 64, fewest_segments = 8, most_segments = 8192;
    int p = 2, q = 3, segments = 512;
    float radius = 0.5f, tube_radius = 0.1f;
    object.read("p", p, 1, most_windings);
    object.read("q", q, 1, most_windings);
    object.read("radius", radius, positive);
    object.read("tube_radius", tube_radius, positive);
    object.read("segments", segments, fewest_segments, most_segments);
    return torus_knot_mesh(p, q, radius, tube_radius, segments);
}

enum class ShapeType { quad, disk, box, sphere, teapot, torus_knot };

std::variant<Shape, Mesh> read_shape_of(ShapeType type, ObjectReader& object) {
    switch (type) {
        case ShapeType::quad:
            return Shape(read_quad(object));
        case ShapeType::disk:
            return Shape(read_disk(object));
        case ShapeType::box:
            return Shape(read_box(object));
        case ShapeType::sphere:
            return Shape(read_sphere(object));
        case ShapeType::teapot:
            return read_teapot(object);
        case ShapeType::torus_knot:
            return read_torus_knot(object);
    }
    return Shape{};
}

/// Of luminance 1; white where none is given.
glm::dvec3 read_color(const std::optional<JsonCursor>& color) {
    const glm::dvec3 rgb = color ? color->vector(not_negative) : glm::vec3(1);
    const double luminance = units::luminance(rgb);
    if (!(luminance > 0)) color->refuse("a colour that is not black");
    return rgb / luminance;
}

/// Intensity in cd from `intensity_cd`, or from `flux_lm` and `color`; the light's distribution must be known.
glm::vec3 read_intensity_cd(ObjectReader& object, const Light& light) {
    const auto intensity = object.find("intensity_cd"), flux = object.find("flux_lm"), color = object.find("color");
    if (!intensity == !flux)
        throw Refusal{object.cursor().path(),
                      fmt::format("expected either intensity_cd or flux_lm, found {}", intensity ? "both" : "neither")};
    if (intensity && color)
        throw Refusal{color->path(), "expected color beside flux_lm alone, found it with intensity_cd"};
    if (intensity) return intensity->number_or_vector(not_negative);
    const glm::vec3 result(read_color(color) * (flux->number(not_negative) / flux_per_candela(light)));
    if (!(glm::max(result.x, glm::max(result.y, result.z)) <= std::numeric_limits<float>::max()))
        flux->refuse("a flux whose intensity single precision holds");
    return result;
}

void read_cone(ObjectReader& object, Light& light) {
    object.read_degrees("inner_deg", light.inner_rad, Range{.low = 0, .high = 90});
    object.read_degrees("outer_deg", light.outer_rad, Range{.low = 0, .high = 90, .low_excluded = true});
    if (light.outer_rad < light.inner_rad)
        throw Refusal{object.cursor().path(),
                      fmt::format("expected outer_deg at least inner_deg ({:.6g}), found {:.6g}", glm::degrees(light.inner_rad),
                                  glm::degrees(light.outer_rad))};
}

void read_directional(ObjectReader& object, Light& light) {
    light.intensity = object.require("illuminance_lux").number_or_vector(not_negative);
    if (const auto direction = object.find("direction")) light.direction = direction->unit_vector();
    object.read_degrees("angular_diameter_deg", light.angular_diameter_rad,
                        Range{.low = 0, .high = 180, .high_excluded = true});
}

LightBlock::Photometry read_photometry(ObjectReader& object) {
    constexpr int most_lamp_sets = 1000;
    LightBlock::Photometry photometry;
    photometry.file = object.require("file").file();
    object.read("lamp_set", photometry.lamp_set, 1, most_lamp_sets);
    object.read("scale", photometry.scale, not_negative);
    if (const auto flux = object.find("flux_lm")) photometry.flux_lm = flux->number(not_negative);
    photometry.color = glm::vec3(read_color(object.find("color")));
    return photometry;
}

}  // namespace

std::variant<Shape, Mesh> read_shape(const JsonCursor& cursor) {
    ObjectReader object(cursor);
    const auto type = object.require("type").one_of<ShapeType>({{"quad", ShapeType::quad},
                                                                {"disk", ShapeType::disk},
                                                                {"box", ShapeType::box},
                                                                {"sphere", ShapeType::sphere},
                                                                {"teapot", ShapeType::teapot},
                                                                {"torus_knot", ShapeType::torus_knot}});
    auto shape = read_shape_of(type, object);
    object.finish();
    return shape;
}

LightBlock read_light(const JsonCursor& cursor) {
    ObjectReader object(cursor);
    LightBlock block;
    Light& light = block.light;
    light.type = object.require("type").one_of<LightType>({{"point", LightType::point},
                                                           {"spot", LightType::spot},
                                                           {"directional", LightType::directional},
                                                           {"ies", LightType::luminaire}});
    if (light.type == LightType::luminaire) {
        block.photometry = read_photometry(object);
    } else if (light.type == LightType::directional) {
        read_directional(object, light);
    } else {
        if (light.type == LightType::spot)
            read_cone(object, light);
        else if (const auto distribution = object.find("distribution"))
            light.lambertian = distribution->one_of<bool>({{"isotropic", false}, {"lambertian", true}});
        light.intensity = read_intensity_cd(object, light);
        object.read("radius_m", light.radius_m, not_negative);
    }
    object.finish();
    return block;
}

}  // namespace heliodon::scene_file
