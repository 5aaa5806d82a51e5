#include "realtime/moving_instances.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

namespace heliodon::realtime {
namespace {

using shading::MaterialData;
using shading::TextureRef;

template <class T>
bool same(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

bool uses_any(const MaterialData& material, const std::vector<std::uint32_t>& textures) {
    const auto any_between = [&](std::size_t first, std::size_t last) {  // those follow one another
        for (std::size_t at = first; at <= last; at += sizeof(TextureRef)) {
            TextureRef use;
            std::memcpy(&use, reinterpret_cast<const std::byte*>(&material) + at, sizeof(use));
            if (use.texture_index != shading::no_texture && std::binary_search(textures.begin(), textures.end(), use.texture_index)) return true;
        }
        return false;
    };
    return any_between(offsetof(MaterialData, base_color_texture), offsetof(MaterialData, clearcoat_roughness_texture)) ||
           any_between(offsetof(MaterialData, anisotropy_texture), offsetof(MaterialData, film_thickness_texture));
}

bool visible(const shading::InstanceData& instance) { return (instance.flags & shading::instance_flag_visible) != 0; }

}  // namespace

void MovingInstances::follow(const convert::FlatScene& scene, const convert::FlatChanges& changes) {
    const auto instances = scene.instances();
    const auto materials = scene.materials();
    if (changes.everything) {
        loaded_revision_ = ++revision_;
        instances_.assign(instances.begin(), instances.end());
        materials_.assign(materials.begin(), materials.end());
        last_changes_.assign(instances.size(), revision_);
        return;
    }
    std::vector<bool> material_changed(materials.size());
    for (const std::uint32_t i : changes.materials)
        material_changed[i] = i >= materials_.size() || !same(materials_[i], materials[i]) || uses_any(materials[i], changes.textures);
    const auto looks_different = [&](const shading::InstanceData& instance) {
        return material_changed[instance.material] ||
               std::binary_search(changes.geometries.begin(), changes.geometries.end(), instance.geometry);
    };
    instances_.resize(instances.size());  // what appears was hidden
    last_changes_.resize(instances.size());
    const std::uint64_t next = revision_ + 1;
    const auto compare = [&](std::uint32_t i) {
        const bool seen = visible(instances_[i]) || visible(instances[i]);
        if (!seen || (same(instances_[i], instances[i]) && !looks_different(instances[i]))) return;
        instances_[i] = instances[i];
        last_changes_[i] = revision_ = next;
    };
    if (changes.materials.empty() && changes.geometries.empty()) std::for_each(changes.instances.begin(), changes.instances.end(), compare);
    else for (std::uint32_t i = 0; i < instances.size(); ++i) compare(i);
    for (const std::uint32_t i : changes.materials) {
        if (i >= materials_.size()) materials_.resize(materials.size());
        materials_[i] = materials[i];
    }
}

std::vector<std::uint32_t> MovingInstances::changed_since(std::uint64_t revision) const {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t i = 0; i < last_changes_.size(); ++i)
        if (last_changes_[i] > revision) changed.push_back(i);
    return changed;
}

}  // namespace heliodon::realtime
