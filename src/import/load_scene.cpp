#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <utility>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/units.h"
#include "import/import.h"
#include "import/mesh_completion.h"

namespace heliodon {
namespace {

constexpr double pi = std::numbers::pi;
/// Mean reflectance that exposure meters assume (ISO 2720:1974 reduces to it): an 18 % grey card.
constexpr double grey_card = 0.18;

double luminance(glm::vec3 rgb) {
    return units::luminance(glm::dvec3(rgb));
}

bool has_lights(const Scene& scene) {
    bool found = false;
    scene.nodes().each([&](NodeId, const Node& node) { found |= node.light.has_value(); });
    return found;
}

/// Mean luminance of the sky over the sphere of directions, cd/m².
double mean_sky_luminance(const Scene& scene) {
    const Sky& sky = scene.sky();
    if (sky.model == SkyModel::constant) return luminance(sky.luminance_nits);
    // Within a factor of 1.5 for every type: near enough for a camera that was given no exposure.
    if (sky.model == SkyModel::cie) return 0.5 * (1 + sky.ground_albedo) * sky.zenith_luminance_nits;
    // Within a factor of 2 by day: the sun's light outside the atmosphere, on level ground, and what dusk leaves of it.
    constexpr double sun_lux = 133100, at_dusk = 1e-3;
    if (sky.is_daylight()) return sun_lux / (2 * pi) * std::max<double>(std::sin(sky.sun_elevation_rad), at_dusk);
    const Texture* image = sky.model == SkyModel::image ? scene.textures().find(sky.image) : nullptr;
    if (!image || image->levels.empty()) return 0;
    double sum = 0, weights = 0;
    for (int y = 0; y < image->height; ++y) {
        const double solid_angle = std::sin(pi * (y + 0.5) / image->height);
        for (int x = 0; x < image->width; ++x) {
            glm::vec4 texel;
            std::memcpy(&texel, &image->levels[0][(std::size_t(y) * image->width + x) * sizeof texel], sizeof texel);
            sum += solid_angle * luminance(glm::vec3(texel) * sky.luminance_nits);
            weights += solid_angle;
        }
    }
    return sum / weights;
}

/// Flux of the glowing surfaces in lm: π · L · A (Lambert), textures left aside.
double emitted_flux(const Scene& scene) {
    double flux = 0;
    scene.nodes().each([&](NodeId id, const Node& node) {
        for (const Part& part : node.parts) {
            const Material* material = scene.materials().find(part.material);
            const Geometry* geometry = scene.geometries().find(part.geometry);
            if (!material || !geometry || material->model == MaterialModel::unlit ||
                luminance(material->emission_nits) <= 0)
                continue;
            const glm::mat4 world = scene.world_matrix(id);
            const Mesh& mesh = geometry->mesh;
            double area = 0;
            for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
                const auto corner = [&](std::size_t k) {
                    return glm::vec3(world * glm::vec4(mesh.positions[mesh.indices[i + k]], 1));
                };
                area += 0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
            }
            flux += pi * luminance(material->emission_nits) * area;
        }
    });
    return flux;
}

/// Mean illuminance that the scene's own light gives its surfaces, lux: the flux of lamps and glowing
/// surfaces over the area of the box round the scene (what a closed room receives directly), half of what
/// directional lights send (the mean over the lit half of a sphere), and π times the sky's mean luminance.
double mean_illuminance(const Scene& scene) {
    const Bounds bounds = scene.bounds();
    const glm::dvec3 e(bounds.extent());
    const double area = 2 * (e.x * e.y + e.y * e.z + e.z * e.x);
    double flux = emitted_flux(scene), illuminance = pi * mean_sky_luminance(scene);
    scene.nodes().each([&](NodeId, const Node& node) {
        if (!node.light) return;
        if (node.light->type == LightType::directional)
            illuminance += luminance(node.light->intensity) / 2;
        else
            flux += flux_lm(*node.light);
    });
    return area > 0 ? illuminance + flux / area : illuminance;
}

/// The exposure a reflected-light meter would set for a grey card under the scene's light: EV100 =
/// log2(L · S / K), K = 12.5 (ISO 2720:1974, section 5).
std::optional<float> metered_ev100(const Scene& scene) {
    constexpr double k = 12.5, iso = 100;
    const double card = grey_card * mean_illuminance(scene) / pi;
    if (!(card > 0) || !std::isfinite(card)) return std::nullopt;
    return float(std::log2(card * iso / k));
}

/// Looks at the whole scene from the front, a little from the right and above, near enough for the box round
/// it just to fit into a square picture.
Camera framing_camera(const Bounds& bounds) {
    Camera camera;
    camera.name = "default";
    camera.vertical_fov_rad = float(40 * pi / 180);
    camera.target = bounds.empty() ? glm::vec3(0) : bounds.center();
    const glm::vec3 backward = glm::normalize(glm::vec3(0.5f, 0.35f, 1.0f));
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), backward)), up = glm::cross(backward, right);
    const glm::vec3 half = bounds.empty() ? glm::vec3(1) : 0.5f * bounds.extent();
    float distance = 1e-6f;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 offset = half * glm::vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const float aside = std::max(std::abs(glm::dot(offset, right)), std::abs(glm::dot(offset, up)));
        distance = std::max(distance, glm::dot(offset, backward) + aside / std::tan(0.5f * camera.vertical_fov_rad));
    }
    camera.position = camera.target + distance * backward;
    return camera;
}

/// The horizontal illuminance of an overcast day that daylight factors are customarily turned into lux with.
constexpr double overcast_lux = 10000;

/// The CIE overcast sky, L = Lz (1 + 2 sin γ) / 3 (Moon & Spencer 1942; ISO 15469:2004, type 16), for which
/// E = 7π/9 · Lz, over a ground of 20 % reflectance that this sky lights.
Texture overcast_sky() {
    constexpr int width = 4, height = 256;
    constexpr double ground_reflectance = 0.2;
    constexpr double zenith = overcast_lux * 9 / (7 * pi), ground = ground_reflectance * overcast_lux / pi;
    Texture sky{.name = "overcast", .width = width, .height = height, .format = TextureFormat::float32};
    sky.wrap_v = Wrap::clamp_to_edge;
    std::vector<std::uint8_t>& level = sky.levels.emplace_back(std::size_t(width) * height * sky.bytes_per_texel());
    for (int y = 0; y < height; ++y) {
        const double elevation = pi / 2 - pi * (y + 0.5) / height;
        const double nits = elevation > 0 ? zenith * (1 + 2 * std::sin(elevation)) / 3 : ground;
        const glm::vec4 texel(glm::vec3(float(nits)), 1.0f);
        for (int x = 0; x < width; ++x)
            std::memcpy(&level[(std::size_t(y) * width + x) * sizeof texel], &texel, sizeof texel);
    }
    build_mip_chain(sky);
    return sky;
}

void make_presentable(Scene& scene, const std::string& where, bool is_model, Warnings& warnings) {
    const bool bring_camera = scene.cameras().size() == 0;
    if (is_model && !has_lights(scene) && scene.sky().model == SkyModel::none) {
        Sky sky;
        sky.model = SkyModel::image;
        sky.luminance_nits = glm::vec3(1);
        sky.image = scene.add_texture(overcast_sky());
        scene.set_sky(sky);
        warnings.push_back(
            {where, fmt::format("has no lights: stands under an overcast sky of {:.0f} lx", overcast_lux)});
    }
    if (bring_camera) {
        scene.add_camera(framing_camera(scene.bounds()));
        warnings.push_back({where, "has no camera: one that sees all of it is taken"});
    }
    // A scene file's cameras carry their own exposure; a model's have none.
    if (!is_model && !bring_camera) return;
    const std::optional<float> ev100 = metered_ev100(scene);
    if (!ev100) return;
    std::vector<CameraId> cameras;
    scene.cameras().each([&](CameraId id, const Camera&) { cameras.push_back(id); });
    for (const CameraId id : cameras) {
        Camera camera = *scene.cameras().find(id);
        camera.ev100_override = *ev100;
        scene.set_camera(id, std::move(camera));
    }
    warnings.push_back(
        {where,
         fmt::format("has no exposure: EV100 {:.2f} is taken, what a meter reads of an 18 % grey card in its light",
                     *ev100)});
}

/// A scene file may give a normal map to a model that came without tangents.
void make_missing_tangents(Scene& scene) {
    std::vector<std::pair<GeometryId, int>> lacking;
    scene.nodes().each([&](NodeId, const Node& node) {
        for (const Part& part : node.parts) {
            const Material* material = scene.materials().find(part.material);
            const Geometry* geometry = scene.geometries().find(part.geometry);
            if (!material || !geometry || (!material->normal_texture.texture && !material->bump_texture.texture))
                continue;
            const int set =
                material->normal_texture.texture ? material->normal_texture.texcoord : material->bump_texture.texcoord;
            if (geometry->mesh.tangents.empty() && !geometry->mesh.texcoords[set].empty())
                lacking.push_back({part.geometry, set});
        }
    });
    for (const auto& [id, set] : lacking) {
        Geometry geometry = *scene.geometries().find(id);
        if (!geometry.mesh.tangents.empty()) continue;
        import::make_tangents(geometry.mesh, set);
        scene.set_geometry(id, std::move(geometry));
    }
}

Result<Scene> model_alone(const std::filesystem::path& path, Warnings& warnings) {
    Scene scene;
    const Result<NodeId> root = import_model(scene, {}, path, warnings);
    if (!root) return tl::unexpected(root.error());
    return scene;
}

/// The scene file that would hold the model alone, so that its fields can be overridden.
Result<Scene> model_with_overrides(const std::filesystem::path& path, std::span<const Override> overrides,
                                   Warnings& warnings) {
    const nlohmann::json text = {{"heliodon", 1},
                                 {"nodes", {{{"name", path.stem().string()}, {"mesh", path.filename().string()}}}}};
    return parse_scene(text.dump(), path.string(), path.parent_path(), overrides, scene_file_readers(), warnings);
}

}  // namespace

Result<Scene> load_scene(const std::filesystem::path& path, std::span<const Override> overrides,
                         Warnings& warnings) try {
    if (path.extension() == ".json") {
        Result<Scene> scene = read_scene_file(path, overrides, scene_file_readers(), warnings);
        if (!scene) return scene;
        make_missing_tangents(*scene);
        make_presentable(*scene, path.string(), false, warnings);
        return scene;
    }
    Result<Scene> scene =
        overrides.empty() ? model_alone(path, warnings) : model_with_overrides(path, overrides, warnings);
    if (!scene) return scene;
    make_missing_tangents(*scene);
    make_presentable(*scene, path.string(), true, warnings);
    return scene;
} catch (const std::exception& exception) {
    return fail(path.string(), exception.what());
}

}  // namespace heliodon
