#include "convert/mean_albedo.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "core/units.h"
#include "shading/bsdf.h"
#include "shading/material_eval.h"

namespace heliodon::convert {
namespace {

using namespace heliodon::shading;

/// Linear; of the smallest level, which is a mean of the whole picture.
glm::vec3 mean_color(const Texture& texture) {
    if (texture.levels.empty()) return glm::vec3(1);
    const std::vector<std::uint8_t>& level = texture.levels.back();
    const std::size_t step = texture.bytes_per_texel();
    glm::dvec3 sum(0);
    for (std::size_t at = 0; at + step <= level.size(); at += step) {
        glm::vec3 value(level[at], level[at + 1], level[at + 2]);
        value /= 255.0f;
        if (texture.format == TextureFormat::float32) std::memcpy(&value, &level[at], sizeof value);
        if (texture.format == TextureFormat::srgb8) value = {units::srgb_decode(value.x), units::srgb_decode(value.y), units::srgb_decode(value.z)};
        sum += glm::dvec3(value);
    }
    return glm::vec3(sum / std::max(1.0, static_cast<double>(level.size() / step)));
}

bool is_opaque(const MaterialData& material) {
    return (material.flags & material_flag_alpha_blend) == 0 && material.model != material_model_thin &&
           material.model != material_model_unlit && material.model != material_model_dielectric && material.transmission == 0;
}

/// As voxels know it: at the mean cosine of an even light, ∫cos² / ∫cos = 2/3.
glm::vec3 albedo(const FlatScene& scene, const MaterialData& material, glm::vec3 vertex_color) {
    MaterialTexels texels = material_texels_default();
    if (const uint index = material.base_color_texture.texture_index; index != no_texture && scene.textures()[index])
        texels.base_color = glm::vec4(mean_color(*scene.textures()[index]), 1);
    if (const uint index = material.orm_texture.texture_index; index != no_texture && scene.textures()[index])
        texels.orm = mean_color(*scene.textures()[index]);
    const Surface surface = material_combine(material, texels, glm::vec4(vertex_color, 1), false).surface;
    const BsdfLobes lobes = bsdf_prepare(surface, vec3(std::sqrt(5.0f) / 3, 0, 2.0f / 3));
    return bsdf_diffuse_albedo_prepared(surface, lobes) + bsdf_specular_albedo_prepared(surface, lobes) +
           bsdf_coat_albedo_prepared(lobes);
}

double world_area(const Mesh& mesh, const glm::mat3& object_to_world) {
    double twice = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const glm::vec3 p = mesh.positions[mesh.indices[i]];
        twice += glm::length(glm::cross(object_to_world * (mesh.positions[mesh.indices[i + 1]] - p),
                                        object_to_world * (mesh.positions[mesh.indices[i + 2]] - p)));
    }
    return 0.5 * twice;
}

glm::vec3 mean_vertex_color(const Mesh& mesh) {
    glm::dvec3 sum(0);
    for (const glm::vec4& color : mesh.colors) sum += glm::dvec3(color);
    return mesh.colors.empty() ? glm::vec3(1) : glm::vec3(sum / static_cast<double>(mesh.colors.size()));
}

/// Turning a thing rounds its metric; areas that differ by so little are one.
bool same_metric(const glm::mat3& a, const glm::mat3& b) {
    float difference = 0, size = 0;
    for (int i = 0; i < 9; ++i) {
        difference = std::max(difference, std::abs(a[i / 3][i % 3] - b[i / 3][i % 3]));
        size = std::max(size, std::abs(b[i / 3][i % 3]));
    }
    return difference <= 1e-5f * size;
}

}  // namespace

glm::vec3 MeanAlbedo::of(const FlatScene& scene, std::span<const std::uint64_t> mesh_revisions) {
    std::map<std::uint32_t, glm::vec3> plain;  // by material, where no vertex colours change it
    glm::dvec3 sum(0);
    double area = 0;
    parts_.resize(scene.instances().size());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const InstanceData& instance = scene.instances()[i];
        const MaterialData& material = scene.materials()[instance.material];
        const Geometry* geometry = (instance.flags & instance_flag_visible) != 0 ? scene.geometries()[instance.geometry] : nullptr;
        if (!geometry || !is_opaque(material)) continue;
        const Mesh& mesh = geometry->mesh;
        const glm::mat3 object_to_world(instance.object_to_world), metric = glm::transpose(object_to_world) * object_to_world;
        const std::uint64_t revision = mesh_revisions[instance.geometry];
        Part& part = parts_[i];
        if (part.geometry != instance.geometry || part.revision != revision || !same_metric(metric, part.metric)) {
            part = {instance.geometry, revision, metric, world_area(mesh, object_to_world), mean_vertex_color(mesh)};
            ++measured_;
        }
        glm::vec3 reflected;
        if (!mesh.colors.empty()) {
            reflected = albedo(scene, material, part.vertex_color);
        } else {
            const auto found = plain.find(instance.material);
            reflected = found != plain.end() ? found->second
                                             : plain.emplace(instance.material, albedo(scene, material, glm::vec3(1))).first->second;
        }
        sum += part.area_m2 * glm::dvec3(reflected);
        area += part.area_m2;
    }
    return area > 0 ? glm::vec3(sum / area) : glm::vec3(0);
}

}  // namespace heliodon::convert
