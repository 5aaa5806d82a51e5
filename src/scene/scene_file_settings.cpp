// Cameras, sensors, sky, and the convert, render and probes blocks.
#include <fmt/format.h>

#include "scene/render_limits.h"
#include "scene/scene_file_parts.h"
#include "scene/time_of_day.h"

namespace heliodon::scene_file {
namespace {

constexpr Range field_of_view_deg{.low = 0, .high = 180, .low_excluded = true, .high_excluded = true};

void check_view(const JsonCursor& cursor, const Camera& camera) {
    const glm::dvec3 view = glm::dvec3(camera.target) - glm::dvec3(camera.position), up = camera.up;
    if (!(glm::length(view) > 0))
        throw Refusal{cursor.path(), "expected position and target apart, found the same point"};
    constexpr double smallest_sine = 1e-6;  // single precision tells no smaller angle apart
    if (!(glm::length(glm::cross(view, up)) > smallest_sine * glm::length(view) * glm::length(up)))
        throw Refusal{cursor.path(), "expected an up vector that is not along the view direction or 0, found one"};
    if (camera.far_m > 0 && camera.far_m <= camera.near_m)
        throw Refusal{cursor.path(), "expected far_m beyond near_m (or 0: infinite), found it nearer"};
}

/// The sun's disc, and where it stands if the block says so.
bool read_sun(const JsonCursor& cursor, Sky& sky) {
    ObjectReader sun(cursor);
    const auto azimuth = sun.find("azimuth_deg"), elevation = sun.find("elevation_deg");
    if (azimuth && !elevation) (void)sun.require("elevation_deg");
    if (elevation && !azimuth) (void)sun.require("azimuth_deg");
    if (azimuth) {
        sky.sun_azimuth_rad = glm::radians(azimuth->number());
        sky.sun_elevation_rad = glm::radians(elevation->number(Range{.low = sky.is_daylight() ? -90.0 : 0.0, .high = 90}));
    }
    const auto disc = sun.find("disc");
    if (disc) sky.sun_disc = disc->boolean();
    if (disc && sky.sun_disc && !sky.is_daylight())
        disc->refuse_as_unsupported("suns with a disc in a CIE sky", "false (a directional light gives the sun's own light)");
    constexpr Range angle_deg{.low = 0, .high = 10, .low_excluded = true};
    sun.read_degrees("angular_diameter_deg", sky.sun_angular_diameter_rad, angle_deg);
    sun.finish();
    return azimuth.has_value();
}

/// The sky's place and time, where it has both of a place; a part of them is refused if they are needed.
void read_place_and_time(ObjectReader& object, bool needed, Sky& sky) {
    constexpr Range latitude_deg{.low = -90, .high = 90}, longitude_deg{.low = -180, .high = 180};
    const auto time = object.find("time"), latitude = object.find("latitude_deg"), longitude = object.find("longitude_deg");
    Place place;
    if (latitude) place.latitude_rad = glm::radians(double(latitude->number(latitude_deg)));
    if (longitude) place.longitude_rad = glm::radians(double(longitude->number(longitude_deg)));
    if (latitude && longitude) sky.place = place;
    if (time) {
        const auto parsed = parse_civil_time(time->name());
        if (!parsed) throw Refusal{time->path(), parsed.error().message};
        sky.time = *parsed;
    }
    if (needed && (time || latitude || longitude))
        for (const char* key : {"latitude_deg", "longitude_deg", "time"}) (void)object.require(key);
}

/// What the sky's formulas use: kept for them, checked for others.
void read_daylight(ObjectReader& object, Sky& sky) {
    const float least = sky.model == SkyModel::preetham ? Sky::least_turbidity_preetham : Sky::least_turbidity_hosek;
    object.read("turbidity", sky.turbidity, Range{.low = least, .high = Sky::most_turbidity});
    object.read("ground_albedo", sky.ground_albedo, unit_interval);
    object.read("cie_type", sky.cie_type, 1, Sky::traditional_overcast);
    object.read("zenith_luminance_nits", sky.zenith_luminance_nits, not_negative);
    const auto sun = object.find("sun");
    if (sun && sky.model != SkyModel::cie && !sky.is_daylight())
        sun->refuse_as_unsupported("suns in the sky", "none with this sky model");
    // Overcast types 1, 3 and 5 and the traditional one are the same all round.
    const bool turns = sky.cie_type != Sky::traditional_overcast && (sky.cie_type > 5 || sky.cie_type % 2 == 0);
    const bool stands = sun && read_sun(*sun, sky), needed = !stands && (sky.is_daylight() || (sky.model == SkyModel::cie && turns));
    read_place_and_time(object, needed, sky);
    if (!needed) return;
    const std::string& path = object.cursor().path();
    if (!sky.place || !sky.time)
        throw Refusal{path, fmt::format("expected where the sun stands, on which the light of {} depends: \"sun\" with azimuth_deg and elevation_deg, or "
                                        "latitude_deg, longitude_deg and time; found neither",
                                        sky.is_daylight() ? "this model" : fmt::format("cie_type {}", sky.cie_type))};
    const double elevation_rad = sun_position(*sky.place, sky.time->unix_s).elevation_rad;
    if (sky.model == SkyModel::cie && elevation_rad < 0)
        throw Refusal{path, fmt::format("expected a time by day with a cie sky, found the sun at an elevation of {:.2f}°", glm::degrees(elevation_rad))};
    sky = sky_at(sky, *sky.time);
}

SkyModel read_sky_model(ObjectReader& sky) {
    const auto model = sky.find("model");
    if (!model) return SkyModel::none;
    return model->one_of<SkyModel>({{"none", SkyModel::none},
                                    {"constant", SkyModel::constant},
                                    {"image", SkyModel::image},
                                    {"preetham", SkyModel::preetham},
                                    {"hosek", SkyModel::hosek},
                                    {"cie", SkyModel::cie}});
}

/// Illuminances over a rectangle (or parallelogram).
void read_sensor_grid(ObjectReader& object, Sensor& sensor) {
    constexpr int most_points_a_side = 1024;
    SensorGrid grid;
    sensor.position = object.require("origin").vector();
    grid.u = object.require("u").vector();
    grid.v = object.require("v").vector();
    const JsonCursor counts = object.require("counts");
    if (!counts.json().is_array() || counts.json().size() != 2) counts.refuse("a list of 2 whole numbers");
    const auto elements = counts.elements();
    grid.counts = {elements[0].integer(1, most_points_a_side), elements[1].integer(1, most_points_a_side)};
    const glm::dvec3 u = grid.u, v = grid.v, normal = glm::cross(u, v);
    constexpr double smallest_sine = 1e-6;  // single precision tells no smaller angle apart
    if (!(glm::length(normal) > smallest_sine * glm::length(u) * glm::length(v)))
        throw Refusal{object.cursor().path(), "expected u and v that span an area, found parallel ones or 0"};
    sensor.direction = glm::vec3(glm::normalize(normal));
    sensor.grid = grid;
}

int read_voxels(const JsonCursor& cursor) {
    const std::string expected = fmt::format("a power of two from {} to {}", fewest_voxels, most_voxels);
    for (int voxels = fewest_voxels; voxels <= most_voxels; voxels *= 2)
        if (cursor.json().is_number() && cursor.json() == voxels) return voxels;
    cursor.refuse(expected);
}

int read_bounces(const JsonCursor& cursor) {
    if (cursor.json() == "inf") return 0;
    if (cursor.json().is_string())
        cursor.refuse(fmt::format("\"inf\" or a whole number from 1 to {}", most_counted_bounces));
    return cursor.integer(1, most_counted_bounces);
}

ConeTracingSettings read_cone_tracing(const JsonCursor& cursor) {
    ObjectReader object(cursor);
    ConeTracingSettings settings;
    object.read("diffuse", settings.diffuse);
    object.read("specular", settings.specular);
    object.read("refraction", settings.refraction);
    object.read("shadows", settings.shadows);
    object.read("ao", settings.ao);
    if (const auto cones = object.find("cones")) {
        settings.cones = cones->integer(hemisphere_cones, most_cones);
        if (settings.cones % hemisphere_cones != 0) cones->refuse(fmt::format("a multiple of {}", hemisphere_cones));
    }
    object.read("narrow", settings.narrow);
    object.read("caustics", settings.caustics);
    if (const auto resolution = object.find("resolution"))
        settings.resolution = resolution->one_of<ConeResolution>(
            {{"full", ConeResolution::full}, {"half", ConeResolution::half}, {"quarter", ConeResolution::quarter}});
    if (const auto filtering = object.find("filtering"))
        settings.filtering = filtering->one_of<VoxelFiltering>(
            {{"anisotropic", VoxelFiltering::anisotropic}, {"isotropic", VoxelFiltering::isotropic}});
    object.finish();
    return settings;
}

ShadowCascadeSettings read_shadow_cascades(const JsonCursor& cursor) {
    ObjectReader object(cursor);
    ShadowCascadeSettings settings;
    object.read("count", settings.count, 1, most_shadow_cascades);
    object.read("split", settings.split, unit_interval);
    object.read("blend", settings.blend, Range{.low = 0, .high = 0.5});
    object.read("distance_m", settings.distance_m, not_negative);
    object.finish();
    return settings;
}

ShadowVolumeSettings read_shadow_volumes(const JsonCursor& cursor) {
    ObjectReader object(cursor);
    ShadowVolumeSettings settings;
    object.read("map_size", settings.map_size, 16, 8192);
    object.read("significant_px", settings.significant_px, Range{.low = 1e-3, .high = 1e4});
    object.finish();
    return settings;
}

AmbientOcclusionSettings read_ambient_occlusion(const JsonCursor& cursor) {
    AmbientOcclusionSettings settings;
    if (cursor.json().is_boolean()) {
        settings.on = cursor.json().get<bool>();
        return settings;
    }
    if (!cursor.json().is_object()) cursor.refuse("true, false or an object");
    ObjectReader object(cursor);
    object.read("reach_m", settings.reach_m, not_negative);
    object.read("thickness_m", settings.thickness_m, not_negative);
    object.finish();
    return settings;
}

}  // namespace

Camera read_camera(const JsonCursor& cursor) {
    ObjectReader object(cursor);
    Camera camera;
    camera.name = object.require("name").name();
    object.read("position", camera.position);
    object.read("target", camera.target);
    object.read("up", camera.up);
    object.read_degrees("vertical_fov_deg", camera.vertical_fov_rad, field_of_view_deg);
    object.read("near_m", camera.near_m, not_negative);
    object.read("far_m", camera.far_m, not_negative);
    object.read("aperture_f", camera.aperture_f, positive);
    object.read("shutter_s", camera.shutter_s, positive);
    object.read("iso", camera.iso, positive);
    if (const auto ev100 = object.find("ev100")) camera.ev100_override = ev100->number();
    object.finish();
    check_view(cursor, camera);
    return camera;
}

Sensor read_sensor(const JsonCursor& cursor) {
    ObjectReader object(cursor);
    Sensor sensor;
    sensor.name = object.require("name").name();
    const JsonCursor type = object.require("type");
    if (type.json() == "grid") {
        read_sensor_grid(object, sensor);
    } else {
        sensor.type = type.one_of<SensorType>(
            {{"illuminance", SensorType::illuminance}, {"luminance", SensorType::luminance}, {"grid", SensorType::illuminance}});
        sensor.position = object.require("position").vector();
        sensor.direction = object.require(sensor.type == SensorType::illuminance ? "normal" : "direction").unit_vector();
    }
    if (const auto offset = object.find("offset_m")) sensor.offset_m = offset->number(not_negative);
    object.finish();
    return sensor;
}

SkyBlock read_sky(const JsonCursor& cursor) {
    ObjectReader object(cursor);
    SkyBlock block;
    block.sky.model = read_sky_model(object);
    if (block.sky.model == SkyModel::image) block.sky.luminance_nits = glm::vec3(1);
    const auto luminance =
        block.sky.model == SkyModel::constant ? object.require("luminance_nits") : object.find("luminance_nits");
    if (luminance) block.sky.luminance_nits = luminance->number_or_vector(not_negative);
    const auto image = block.sky.model == SkyModel::image ? object.require("image") : object.find("image");
    if (image && block.sky.model == SkyModel::image)
        block.image = image->file();
    else if (image)
        (void)image->file();
    object.read_degrees("north_deg", block.sky.north_rad, any_number);
    read_daylight(object, block.sky);
    object.finish();
    return block;
}

ConvertSettings read_convert_settings(const JsonCursor& cursor) {
    constexpr int largest_texture = 65536, fewest_segments = 3, most_segments = 1024;
    ObjectReader object(cursor);
    ConvertSettings settings;
    object.read("texture_size_limit", settings.texture_size_limit, 0, largest_texture);
    object.read("shape_segments", settings.shape_segments, fewest_segments, most_segments);
    if (const auto precision = object.find("vertex_precision"))
        settings.vertex_precision = precision->one_of<ConvertSettings::Precision>(
            {{"full", ConvertSettings::Precision::full}, {"compact", ConvertSettings::Precision::compact}});
    object.finish();
    return settings;
}

RenderSettings read_render_settings(const JsonCursor& cursor) {
    constexpr int smallest_shadow_map = 16, largest_shadow_map = 16384;
    ObjectReader object(cursor);
    RenderSettings settings;
    if (const auto gi = object.find("gi"))
        settings.gi = gi->one_of<std::string>(
            {{"none", "none"}, {"vct", "vct"}, {"probes", "probes"}, {"lightmaps", "lightmaps"}});
    if (const auto voxels = object.find("voxels")) settings.voxels = read_voxels(*voxels);
    object.read("cascades", settings.cascades, 1, most_voxel_cascades);
    if (const auto bounces = object.find("bounces")) settings.bounces = read_bounces(*bounces);
    if (const auto revoxelize = object.find("revoxelize"))
        settings.revoxelize = revoxelize->one_of<Revoxelize>(
            {{"once", Revoxelize::once}, {"changed", Revoxelize::changed}, {"always", Revoxelize::always}});
    if (const auto voxelizer = object.find("voxelizer"))
        settings.voxelizer = voxelizer->one_of<Voxelizer>(
            {{"automatic", Voxelizer::automatic}, {"raster", Voxelizer::raster}, {"compute", Voxelizer::compute}});
    if (const auto rasterizer = object.find("rasterizer"))
        settings.rasterizer = rasterizer->one_of<Rasterizer>(
            {{"automatic", Rasterizer::automatic}, {"hardware", Rasterizer::hardware}, {"compute", Rasterizer::compute}});
    if (const auto integrator = object.find("integrator"))
        settings.integrator = integrator->one_of<Integrator>(
            {{"path", Integrator::path}, {"bidirectional", Integrator::bidirectional}});
    if (const auto vct = object.find("vct")) settings.vct = read_cone_tracing(*vct);
    if (const auto ambient = object.find("ambient"))
        settings.ambient = ambient->one_of<AmbientLight>({{"none", AmbientLight::none},
                                                          {"constant", AmbientLight::constant},
                                                          {"directional", AmbientLight::directional}});
    if (const auto occlusion = object.find("ambient_occlusion"))
        settings.ambient_occlusion = read_ambient_occlusion(*occlusion);
    settings.display = read_display(object);
    object.read("shadow_map_size", settings.shadow_map_size, smallest_shadow_map, largest_shadow_map);
    if (const auto sun_shadows = object.find("sun_shadows"))
        settings.sun_shadows = sun_shadows->one_of<SunShadows>({{"cascades", SunShadows::cascades}, {"volumes", SunShadows::volumes}});
    if (const auto cascades = object.find("shadow_cascades")) settings.shadow_cascades = read_shadow_cascades(*cascades);
    if (const auto volumes = object.find("shadow_volumes")) settings.shadow_volumes = read_shadow_volumes(*volumes);
    object.finish();
    return settings;
}

void check_probes(const JsonCursor& cursor) {
    constexpr int most_probes_a_side = 4096;
    ObjectReader object(cursor);
    const glm::vec3 low = object.require("min").vector(), high = object.require("max").vector();
    const JsonCursor counts = object.require("counts");
    if (!counts.json().is_array() || counts.json().size() != 3) counts.refuse("a list of 3 whole numbers");
    for (const JsonCursor& count : counts.elements()) (void)count.integer(1, most_probes_a_side);
    if (glm::any(glm::greaterThan(low, high))) object.require("max").refuse("a corner not below min");
    object.finish();
}

}  // namespace heliodon::scene_file
