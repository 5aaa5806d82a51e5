#include "convert/flat_scene.h"

#include <algorithm>
#include <type_traits>

#include "convert/pack.h"

namespace heliodon::convert {
namespace {

using shading::instance_flag_visible;

// Both engines hold on to vertex arrays while the scene's table of geometries grows.
static_assert(std::is_nothrow_move_constructible_v<Geometry>);

void sort_unique(std::vector<std::uint32_t>& indices) {
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

template <class T>
std::uint32_t allocate(std::vector<T>& table, std::vector<std::uint32_t>& free) {
    if (!free.empty()) {
        const std::uint32_t index = free.back();
        free.pop_back();
        return index;
    }
    table.emplace_back();
    return static_cast<std::uint32_t>(table.size() - 1);
}

std::uint32_t material_index(const Scene& scene, MaterialId id) {
    return scene.materials().contains(id) ? id.index + 1 : 0;
}

}  // namespace

FlatChanges FlatScene::update(const Scene& scene) {
    FlatChanges changes;
    std::vector<std::uint32_t> nodes, subtrees;
    bool tables = false, materials_removed = false;
    const auto note = [&](const Change& change) {
        switch (change.table) {
            case Change::Table::geometry: changes.geometries.push_back(change.index); tables = true; break;
            case Change::Table::texture: changes.textures.push_back(change.index); tables = true; break;
            case Change::Table::material:
                changes.materials.push_back(change.index);
                materials_removed |= (change.aspects & Change::removed) != 0;
                break;
            case Change::Table::node: {
                const std::uint8_t whole = Change::transform | Change::hierarchy | Change::visibility;
                (change.aspects & whole ? subtrees : nodes).push_back(change.index);
                break;
            }
            case Change::Table::sky: changes.sky = true; break;
            default: break;
        }
    };
    const bool reached = built_ && scene.changes_since(journal_position_, note);
    journal_position_ = scene.journal_end();
    if (!reached || scene.convert_settings().texture_size_limit != texture_size_limit_) {
        rebuild(scene);
        changes = {};
        changes.everything = true;
        return changes;
    }

    if (tables) refresh_tables(scene);
    sort_unique(changes.geometries);
    sort_unique(changes.textures);
    std::vector<std::uint32_t> material_slots;
    material_slots.swap(changes.materials);
    // A texture that came or went changes what its materials may name.
    if (!changes.textures.empty()) {
        for (std::uint32_t slot = 0; slot < scene.materials().capacity(); ++slot) material_slots.push_back(slot);
        changes.sky = true;
    }
    sort_unique(material_slots);
    for (const std::uint32_t slot : material_slots) write_material(scene, slot, changes);
    // Nodes that use a geometry or a material that came or went show it or hide.
    if (!changes.geometries.empty() || materials_removed)
        for (std::uint32_t slot = 0; slot < scene.nodes().capacity(); ++slot)
            if (const Node* node = scene.nodes().at(slot); node && !node->parts.empty()) nodes.push_back(slot);
    sort_unique(nodes);
    sort_unique(subtrees);
    for (const std::uint32_t slot : nodes) {
        if (!scene.nodes().at(slot)) clear_node(slot, changes);
        else {
            const NodeId id = scene.nodes().id_at(slot);
            write_node(scene, slot, scene.world_matrix(id), scene.world_visible(id), changes);
        }
    }
    for (const std::uint32_t slot : subtrees) write_subtree(scene, slot, changes);
    if (changes.sky) write_sky(scene, changes);
    sort_unique(changes.instances);
    sort_unique(changes.lights);
    return changes;
}

Bounds FlatScene::bounds() const {
    Bounds result;
    for (const shading::InstanceData& instance : instances_)
        if (instance.flags & instance_flag_visible)
            result.include(geometries_[instance.geometry]->bounds.transformed(instance.object_to_world));
    return result;
}

void FlatScene::rebuild(const Scene& scene) {
    built_ = true;
    node_entries_.clear();
    free_instances_.clear();
    free_lights_.clear();
    materials_.clear();
    instances_.clear();
    lights_.clear();
    luminaires_.clear();
    texture_size_limit_ = scene.convert_settings().texture_size_limit;
    refresh_tables(scene);
    FlatChanges ignored;
    materials_.push_back(pack_material(scene, Material{}));
    for (std::uint32_t slot = 0; slot < scene.materials().capacity(); ++slot) write_material(scene, slot, ignored);
    for (const NodeId root : scene.roots()) write_subtree(scene, root.index, ignored);
    sun_ = no_sun;
    write_sky(scene, ignored);
}

void FlatScene::refresh_tables(const Scene& scene) {
    geometries_.resize(scene.geometries().capacity());
    for (std::uint32_t i = 0; i < geometries_.size(); ++i) geometries_[i] = scene.geometries().at(i);
    textures_.resize(scene.textures().capacity());
    first_levels_.resize(textures_.size());
    for (std::uint32_t i = 0; i < textures_.size(); ++i) {
        textures_[i] = scene.textures().at(i);
        first_levels_[i] = textures_[i] ? first_level(*textures_[i], texture_size_limit_) : 0;
    }
}

void FlatScene::write_material(const Scene& scene, std::uint32_t slot, FlatChanges& changes) {
    if (materials_.size() < slot + 2) materials_.resize(slot + 2, materials_.front());
    const Material* material = scene.materials().at(slot);
    materials_[slot + 1] = pack_material(scene, material ? *material : Material{});
    changes.materials.push_back(slot + 1);
}

void FlatScene::write_node(const Scene& scene, std::uint32_t slot, const glm::mat4& world, bool visible, FlatChanges& changes) {
    const Node& node = *scene.nodes().at(slot);
    if (node_entries_.size() <= slot) node_entries_.resize(slot + 1);
    NodeEntries& entries = node_entries_[slot];
    while (entries.instances.size() > node.parts.size()) {
        const std::uint32_t index = entries.instances.back();
        entries.instances.pop_back();
        instances_[index].flags = 0;
        free_instances_.push_back(index);
        changes.instances.push_back(index);
    }
    while (entries.instances.size() < node.parts.size()) entries.instances.push_back(allocate(instances_, free_instances_));
    for (std::size_t i = 0; i < node.parts.size(); ++i) {
        const Part& part = node.parts[i];
        const Geometry* geometry = scene.geometries().find(part.geometry);
        const bool drawn = visible && geometry && !geometry->mesh.indices.empty();
        instances_[entries.instances[i]] =
            pack_instance(world, geometry ? part.geometry.index : 0, material_index(scene, part.material), drawn);
        changes.instances.push_back(entries.instances[i]);
    }
    constexpr std::uint32_t none = NodeEntries{}.light;
    if (node.light && entries.light == none) entries.light = allocate(lights_, free_lights_);
    if (entries.light == none) return;
    lights_[entries.light] = node.light && visible ? flat_light(*node.light, world, changes) : no_light();
    changes.lights.push_back(entries.light);
    if (!node.light) {
        free_lights_.push_back(entries.light);
        entries.light = none;
    }
}

shading::LightData FlatScene::flat_light(const Light& light, const glm::mat4& world, FlatChanges& changes) {
    if (light.type != LightType::luminaire) return pack_light(light, world);
    if (!light.luminaire) return no_light();
    const std::size_t before = luminaires_.values().size();
    const LuminaireTables::Place place = luminaires_.place(light.luminaire);
    changes.luminaires = changes.luminaires || luminaires_.values().size() != before;
    return pack_luminaire(light, world, place);
}

void FlatScene::write_sky(const Scene& scene, FlatChanges& changes) {
    sky_ = pack_sky(scene);
    const std::optional<shading::LightData> sun = pack_sun(scene.sky());
    if (sun && sun_ == no_sun) sun_ = allocate(lights_, free_lights_);
    if (sun_ == no_sun) return;
    lights_[sun_] = sun.value_or(no_light());
    changes.lights.push_back(sun_);
    if (sun) return;
    free_lights_.push_back(sun_);
    sun_ = no_sun;
}

void FlatScene::clear_node(std::uint32_t slot, FlatChanges& changes) {
    if (slot >= node_entries_.size()) return;
    NodeEntries& entries = node_entries_[slot];
    for (const std::uint32_t index : entries.instances) {
        instances_[index].flags = 0;
        free_instances_.push_back(index);
        changes.instances.push_back(index);
    }
    if (entries.light != NodeEntries{}.light) {
        lights_[entries.light] = no_light();
        free_lights_.push_back(entries.light);
        changes.lights.push_back(entries.light);
    }
    entries = {};
}

void FlatScene::write_subtree(const Scene& scene, std::uint32_t slot, FlatChanges& changes) {
    if (!scene.nodes().at(slot)) return clear_node(slot, changes);
    struct Visit {
        NodeId id;
        glm::mat4 world;
        bool visible;
    };
    const NodeId id = scene.nodes().id_at(slot);
    std::vector<Visit> pending{{id, scene.world_matrix(id), scene.world_visible(id)}};
    while (!pending.empty()) {
        const Visit visit = pending.back();
        pending.pop_back();
        write_node(scene, visit.id.index, visit.world, visit.visible, changes);
        for (const NodeId child_id : scene.nodes().find(visit.id)->children()) {
            const Node& child = *scene.nodes().find(child_id);
            pending.push_back({child_id, visit.world * child.local_matrix(), visit.visible && child.visible});
        }
    }
}

}  // namespace heliodon::convert
