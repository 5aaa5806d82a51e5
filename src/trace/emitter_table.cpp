#include "trace/emitter_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"
#include "shading/sky.h"
#include "trace/emitter_bounds.h"

namespace heliodon::trace {
namespace {

using shading::kernel_no_emitter;
using shading::KernelEmitter;

constexpr double pi = std::numbers::pi;

double luminance(const glm::vec3& rgb) {
    return units::luminance(glm::dvec3(rgb));
}

/// Emitters with their flux in lumen, grouped: one group a light, an emissive instance or the sky.
struct Draft {
    std::vector<KernelEmitter> emitters;
    std::vector<double> flux;
    std::vector<std::size_t> group_begin;
    void begin_group() { group_begin.push_back(emitters.size()); }
    void add(const KernelEmitter& emitter, double lumen) {
        emitters.push_back(emitter);
        emitters.back().light_node = kernel_no_emitter;
        emitters.back().lengths = {glm::length(emitter.edge0), glm::length(emitter.edge1)};
        const glm::vec3 normal = glm::cross(emitter.edge0, emitter.edge1) * emitter.orientation;
        if (normal != glm::vec3(0)) emitters.back().normal = glm::normalize(normal);
        flux.push_back(std::isfinite(lumen) ? std::max(lumen, 0.0) : 0.0);
    }
};

double light_flux(const shading::LightData& light, double scene_radius) {
    const double intensity = luminance(light.intensity);
    switch (light.type) {
        case shading::light_type_point:
            return 4 * pi * intensity;
        case shading::light_type_lambertian:
            return pi * intensity;
        case shading::light_type_spot:
            return 2 * pi * intensity * ((1.0 - light.cos_inner) + (light.cos_inner - light.cos_outer) / 3.0);
        case shading::light_type_luminaire:
            return intensity * light.flux_factor;
        case shading::light_type_directional:
            return intensity * pi * scene_radius * scene_radius;
        default:
            return 0;
    }
}

/// Those that are directional, or all others.
void add_lights(const convert::FlatScene& flat, double scene_radius, bool directional, EmitterTable& table,
                Draft& draft) {
    table.light_emitter.resize(flat.lights().size(), kernel_no_emitter);
    for (std::uint32_t i = 0; i < flat.lights().size(); ++i) {
        const shading::LightData& light = flat.lights()[i];
        if ((light.type == shading::light_type_directional) != directional) continue;
        const double lumen = light_flux(light, scene_radius);
        if (!(lumen > 0)) continue;
        table.light_emitter[i] = static_cast<std::uint32_t>(draft.emitters.size());
        if (light.radius > 0) table.visible_lights.push_back(i);
        KernelEmitter emitter{};
        emitter.kind = shading::kernel_emitter_light;
        emitter.index = i;
        draft.begin_group();
        draft.add(emitter, lumen);
    }
}

/// The emitted luminance relative to the material's, over a triangle: at its corners and middle, and a part
/// of the whole texture's so that a bright spot between them is not missed altogether.
double texture_weight(const Mesh& mesh, const shading::TextureRef& use, const TextureTable& textures,
                      std::uint32_t triangle) {
    if (use.texture_index == shading::no_texture) return 1;
    const auto& texcoords = mesh.texcoords[use.texcoord & 1];
    if (texcoords.empty()) return 1;
    const glm::mat2 matrix(use.uv_matrix.x, use.uv_matrix.y, use.uv_matrix.z, use.uv_matrix.w);
    glm::vec2 uv[3];
    for (int k = 0; k < 3; ++k) uv[k] = matrix * texcoords[mesh.indices[3 * triangle + k]] + use.uv_offset;
    const glm::vec2 middle = (uv[0] + uv[1] + uv[2]) / 3.0f;
    double sum = luminance(glm::vec3(textures.sample(use.texture_index, middle)));
    for (const glm::vec2& corner : uv)
        sum += luminance(glm::vec3(textures.sample(use.texture_index, glm::mix(middle, corner, 0.7f))));
    constexpr double floor = 0.02;  // of full emission: an estimate only, the sampling stays unbiased
    return sum / 4 + floor;
}

void add_triangles(const Geometry& geometry, const shading::MaterialData& material, const glm::mat4& world,
                   KernelEmitter emitter, double luminous_exitance, const TextureTable& textures, Draft& draft) {
    const Mesh& mesh = geometry.mesh;
    emitter.kind = shading::kernel_emitter_triangle;
    for (std::uint32_t triangle = 0; triangle < mesh.triangle_count(); ++triangle) {
        glm::vec3 corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = glm::vec3(world * glm::vec4(mesh.positions[mesh.indices[3 * triangle + k]], 1));
        emitter.origin = corner[0];
        emitter.edge0 = corner[1] - corner[0];
        emitter.edge1 = corner[2] - corner[0];
        emitter.primitive = triangle;
        emitter.area = 0.5f * glm::length(glm::cross(emitter.edge0, emitter.edge1));
        draft.add(emitter, luminous_exitance * emitter.area *
                               texture_weight(mesh, material.emission_texture, textures, triangle));
    }
}

void add_shape(const Shape& shape, const glm::mat4& world, KernelEmitter emitter, double luminous_exitance,
               Draft& draft) {
    const glm::mat3 linear(world);
    if (const auto* quad = std::get_if<Quad>(&shape)) {
        emitter.kind = shading::kernel_emitter_quad;
        emitter.origin = glm::vec3(world * glm::vec4(quad->origin, 1));
        emitter.edge0 = linear * quad->u;
        emitter.edge1 = linear * quad->v;
        emitter.area = glm::length(glm::cross(emitter.edge0, emitter.edge1));
        const float skew =
            glm::dot(emitter.edge0, emitter.edge1) / (glm::length(emitter.edge0) * glm::length(emitter.edge1));
        if (std::abs(skew) < 1e-5f) emitter.kind = shading::kernel_emitter_rectangle;
        draft.add(emitter, luminous_exitance * emitter.area);
    } else if (const auto* disk = std::get_if<Disk>(&shape)) {
        emitter.kind = shading::kernel_emitter_disk;
        const glm::vec3 normal = glm::normalize(disk->normal), tangent = disk_tangent(normal);
        emitter.origin = glm::vec3(world * glm::vec4(disk->center, 1));
        emitter.edge0 = linear * (disk->radius * tangent);
        emitter.edge1 = linear * (disk->radius * glm::cross(normal, tangent));
        emitter.area = static_cast<float>(pi) * glm::length(glm::cross(emitter.edge0, emitter.edge1));
        draft.add(emitter, luminous_exitance * emitter.area);
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        emitter.kind = shading::kernel_emitter_sphere;
        emitter.origin = glm::vec3(world * glm::vec4(sphere->center, 1));
        const float scale = glm::length(linear[0]);
        const glm::mat3 gram = glm::transpose(linear) * linear / (scale * scale);
        float deviation = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) deviation = std::max(deviation, std::abs(gram[i][j] - (i == j ? 1.0f : 0.0f)));
        emitter.area = deviation < 1e-5f ? sphere->radius * scale : 0.0f;
        const double mean_radius = sphere->radius * std::cbrt(std::abs(glm::determinant(linear)));
        draft.add(emitter, luminous_exitance * 4 * pi * mean_radius * mean_radius);
    }
}

void add_instances(const convert::FlatScene& flat, const TextureTable& textures, EmitterTable& table, Draft& draft) {
    table.first_emitter.assign(flat.instances().size(), kernel_no_emitter);
    for (std::uint32_t i = 0; i < flat.instances().size(); ++i) {
        const shading::InstanceData& instance = flat.instances()[i];
        if (!(instance.flags & shading::instance_flag_visible) || !flat.geometries()[instance.geometry]) continue;
        const shading::MaterialData& material = flat.materials()[instance.material];
        if (!(material.flags & shading::material_flag_emissive)) continue;
        table.scattered_emission = true;
        // Unlit surfaces show a picture and are no lamps: seen where a ray meets them, never aimed at.
        if (material.model == shading::material_model_unlit) continue;
        const Geometry& geometry = *flat.geometries()[instance.geometry];
        const double sides = material.flags & shading::material_flag_two_sided ? 2 : 1;
        const double exitance = sides * pi * luminance(material.emission_nits);
        KernelEmitter emitter{};
        emitter.index = i;
        emitter.orientation = instance.determinant_sign;
        table.first_emitter[i] = static_cast<std::uint32_t>(draft.emitters.size());
        draft.begin_group();
        if (geometry.shape && !std::holds_alternative<Box>(*geometry.shape))
            add_shape(*geometry.shape, instance.object_to_world, emitter, exitance, draft);
        else
            add_triangles(geometry, material, instance.object_to_world, emitter, exitance, textures, draft);
    }
}

/// Mean luminance over a cell of the sky's sampling table, roughly: sampling stays unbiased.
double sky_cell_luminance(const shading::SkyData& sky, const TextureTable& textures, glm::ivec2 cells, glm::ivec2 cell) {
    const glm::ivec2 size = textures.size(sky.texture_index);
    if (sky.model != shading::sky_model_image) {
        constexpr int points = 3;  // a side
        double sum = 0;
        for (int i = 0; i < points * points; ++i) {
            const glm::vec2 uv = (glm::vec2(cell) + (glm::vec2(i % points, i / points) + 0.5f) / float(points)) / glm::vec2(cells);
            sum += luminance(shading::sky_radiance(sky, shading::sky_direction(uv, sky.north_rad), glm::vec3(1)));
        }
        return sum / (points * points);
    }
    // Texels of the cell and half a texel round it: where interpolation can carry light from.
    const int x0 = static_cast<int>(std::floor(double(cell.x) * size.x / cells.x - 0.5));
    const int x1 = static_cast<int>(std::floor(double(cell.x + 1) * size.x / cells.x + 0.5));
    const int y0 = static_cast<int>(std::floor(double(cell.y) * size.y / cells.y - 0.5));
    const int y1 = static_cast<int>(std::floor(double(cell.y + 1) * size.y / cells.y + 0.5));
    double sum = 0;
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
            sum += luminance(glm::vec3(textures.sample(
                sky.texture_index, {(x + 0.5f) / size.x, std::clamp((y + 0.5f) / size.y, 0.0f, 1.0f)})));
    return luminance(sky.luminance) * std::max(0.0, sum) / ((x1 - x0 + 1) * (y1 - y0 + 1));
}

void add_sky(const convert::FlatScene& flat, const TextureTable& textures, double scene_radius, EmitterTable& table,
             Draft& draft) {
    const shading::SkyData& sky = flat.sky();
    if (sky.model == shading::sky_model_none) return;
    table.scattered_emission = true;
    // A constant sky needs no light sampling: scattered rays already follow the surface's own weights.
    if (sky.model == shading::sky_model_constant) return;
    // Formulas are smooth but about the sun and the horizon, which is the border of two rows.
    constexpr glm::ivec2 formula_cells(256, 128), most_cells(1024, 512);
    const bool image = sky.model == shading::sky_model_image;
    const glm::ivec2 size = image ? textures.size(sky.texture_index) : formula_cells;
    const int columns = std::clamp(size.x, 1, most_cells.x), rows = std::clamp(size.y, 1, most_cells.y);
    std::vector<double> weights(static_cast<std::size_t>(columns) * rows);
    double mean = 0;
    for (int row = 0; row < rows; ++row) {
        const double cap = std::cos(pi * row / rows) - std::cos(pi * (row + 1) / rows);
        for (int column = 0; column < columns; ++column) {
            const double average = sky_cell_luminance(sky, textures, {columns, rows}, {column, row});
            weights[static_cast<std::size_t>(row) * columns + column] = average * cap;
            mean += 0.5 * average * cap / columns;
        }
    }
    if (!(mean > 0) || !std::isfinite(mean)) return;
    table.sky_columns = columns;
    table.sky_rows = rows;
    table.sky_cumulative.resize(rows + weights.size());
    double total = 0, running = 0;
    for (const double weight : weights) total += weight;
    for (int row = 0; row < rows; ++row) {
        double row_sum = 0, in_row = 0;
        const double* first = &weights[static_cast<std::size_t>(row) * columns];
        for (int column = 0; column < columns; ++column) row_sum += first[column];
        running += row_sum;
        table.sky_cumulative[row] = row + 1 == rows ? 1.0f : static_cast<float>(running / total);
        for (int column = 0; column < columns; ++column) {
            in_row += first[column];
            const bool last = column + 1 == columns;
            table.sky_cumulative[rows + static_cast<std::size_t>(row) * columns + column] =
                last || !(row_sum > 0) ? 1.0f : static_cast<float>(in_row / row_sum);
        }
    }
    table.sky_emitter = static_cast<std::uint32_t>(draft.emitters.size());
    KernelEmitter emitter{};
    emitter.kind = shading::kernel_emitter_sky;
    draft.begin_group();
    draft.add(emitter, 4 * pi * mean * pi * scene_radius * scene_radius);
}

/// Turns fluxes into probabilities.
void normalize(const Draft& draft, EmitterTable& table) {
    table.emitters = draft.emitters;
    double total = 0;
    for (const double lumen : draft.flux) total += lumen;
    std::size_t lit_groups = 0;
    std::vector<double> group_flux(draft.group_begin.size());
    const auto group_end = [&](std::size_t group) {
        return group + 1 < draft.group_begin.size() ? draft.group_begin[group + 1] : draft.emitters.size();
    };
    for (std::size_t group = 0; group < group_flux.size(); ++group) {
        for (std::size_t i = draft.group_begin[group]; i < group_end(group); ++i) group_flux[group] += draft.flux[i];
        lit_groups += group_flux[group] > 0 ? 1 : 0;
    }
    table.total_flux = total;
    table.lit_groups = static_cast<int>(lit_groups);
    double cumulative = 0;
    for (std::size_t group = 0; group < group_flux.size(); ++group) {
        for (std::size_t i = draft.group_begin[group]; i < group_end(group); ++i) {
            const double share = group_flux[group] > 0 ? draft.flux[i] / group_flux[group] : 0.0;
            const double probability =
                lit_groups ? 0.5 * draft.flux[i] / total + 0.5 * share / static_cast<double>(lit_groups) : 0.0;
            cumulative += probability;
            table.emitters[i].probability = static_cast<float>(probability);
            table.emitters[i].cumulative = static_cast<float>(cumulative);
        }
    }
    // Rounding must not leave a gap below 1 that no emitter owns.
    for (std::size_t i = table.emitters.size(); i-- > 0;) {
        table.emitters[i].cumulative = 1.0f;
        if (table.emitters[i].probability > 0) break;
    }
}

void plant_light_tree(const convert::FlatScene& flat, const Draft& draft, EmitterTable& table) {
    std::vector<LightBounds> lights;
    std::vector<std::uint32_t> emitters, leaves;
    for (auto i = table.distant_emitters; i < table.emitters.size(); ++i) {
        if (!(table.emitters[i].probability > 0)) continue;
        lights.push_back(emitter_bounds(flat, table.emitters[i], draft.flux[i]));
        emitters.push_back(i);
    }
    table.light_nodes = build_light_tree(lights, emitters, leaves);
    for (std::size_t i = 0; i < emitters.size(); ++i) table.emitters[emitters[i]].light_node = leaves[i];
}

}  // namespace

EmitterTable build_emitters(const convert::FlatScene& flat, const TextureTable& textures, bool environment) {
    EmitterTable table;
    Draft draft;
    const Bounds bounds = flat.bounds();
    const double scene_radius = bounds.empty() ? 1.0 : std::max(0.5 * bounds.diagonal(), 1e-6);
    add_lights(flat, scene_radius, true, table, draft);
    if (environment) add_sky(flat, textures, scene_radius, table, draft);
    table.distant_emitters = static_cast<std::uint32_t>(draft.emitters.size());
    add_lights(flat, scene_radius, false, table, draft);
    add_instances(flat, textures, table, draft);
    table.scattered_emission = table.scattered_emission || !table.visible_lights.empty();
    normalize(draft, table);
    plant_light_tree(flat, draft, table);
    return table;
}

}  // namespace heliodon::trace
