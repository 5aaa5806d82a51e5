#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "convert/pack_luminaire.h"
#include "scene/scene.h"
#include "shading/scene_data.h"

namespace heliodon::convert {

/// What one update touched: indices into FlatScene's tables, each once, ascending.
struct FlatChanges {
    bool everything = false;  ///< first update, or the journal was outrun
    std::vector<std::uint32_t> geometries;  ///< added, changed or removed (null in the table)
    std::vector<std::uint32_t> textures;
    std::vector<std::uint32_t> materials;
    std::vector<std::uint32_t> instances;
    std::vector<std::uint32_t> lights;
    bool sky = false;
    bool luminaires = false;  ///< the table of luminaires has grown
    [[nodiscard]] bool any() const {
        return everything || sky || !geometries.empty() || !textures.empty() || !materials.empty() ||
               !instances.empty() || !lights.empty() || luminaires;
    }
};

/// The flat form both engines read: world-space instances and lights, packed materials. It follows the
/// scene's journal, so that moving one node touches that node's instances and lights alone. Geometry and
/// texture tables point at the scene's own copies. Indices are stable; holes are instances that are not
/// visible, lights of type none, null geometries and textures.
class FlatScene {
public:
    /// Reads `scene`'s journal up to its end. `scene` must be the same object at every call and outlive
    /// the pointers in the tables.
    FlatChanges update(const Scene& scene);

    [[nodiscard]] std::span<const Geometry* const> geometries() const { return geometries_; }
    [[nodiscard]] std::span<const Texture* const> textures() const { return textures_; }
    /// First mip level that the texture size limit lets through, by texture index.
    [[nodiscard]] std::span<const std::uint32_t> texture_first_levels() const { return first_levels_; }
    /// By material slot + 1; entry 0 is the default material.
    [[nodiscard]] std::span<const shading::MaterialData> materials() const { return materials_; }
    [[nodiscard]] std::span<const shading::InstanceData> instances() const { return instances_; }
    [[nodiscard]] std::span<const shading::LightData> lights() const { return lights_; }
    /// What shading/luminaire.h reads. It only grows until the whole scene is flattened anew.
    [[nodiscard]] std::span<const float> luminaire_table() const { return luminaires_.values(); }
    [[nodiscard]] const shading::SkyData& sky() const { return sky_; }
    /// World bounds of the visible instances.
    [[nodiscard]] Bounds bounds() const;

private:
    /// The instances and the light that stand for one node.
    struct NodeEntries {
        std::vector<std::uint32_t> instances;
        std::uint32_t light = 0xffffffffu;
    };
    void rebuild(const Scene& scene);
    void refresh_tables(const Scene& scene);
    void write_material(const Scene& scene, std::uint32_t slot, FlatChanges& changes);
    void write_node(const Scene& scene, std::uint32_t slot, const glm::mat4& world, bool visible, FlatChanges& changes);
    [[nodiscard]] shading::LightData flat_light(const Light& light, const glm::mat4& world, FlatChanges& changes);
    void write_sky(const Scene& scene, FlatChanges& changes);
    void clear_node(std::uint32_t slot, FlatChanges& changes);
    void write_subtree(const Scene& scene, std::uint32_t slot, FlatChanges& changes);

    std::uint64_t journal_position_ = 0;
    bool built_ = false;
    int texture_size_limit_ = 0;
    std::vector<NodeEntries> node_entries_;
    std::vector<std::uint32_t> free_instances_, free_lights_;
    std::vector<const Geometry*> geometries_;
    std::vector<const Texture*> textures_;
    std::vector<std::uint32_t> first_levels_;
    std::vector<shading::MaterialData> materials_;
    std::vector<shading::InstanceData> instances_;
    std::vector<shading::LightData> lights_;
    LuminaireTables luminaires_;
    shading::SkyData sky_{};
    std::uint32_t sun_ = no_sun;  ///< among lights_
    static constexpr std::uint32_t no_sun = 0xffffffffu;
};

}  // namespace heliodon::convert
