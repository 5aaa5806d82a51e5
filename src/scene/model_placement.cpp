#include "scene/model_placement.h"

#include <algorithm>
#include <set>
#include <utility>

namespace heliodon::scene_file {
namespace {

std::vector<TextureId> textures_of(const Material& material) {
    return {material.base_color_texture.texture,
            material.orm_texture.texture,
            material.occlusion_texture.texture,
            material.normal_texture.texture,
            material.bump_texture.texture,
            material.emission_texture.texture,
            material.transmission_texture.texture,
            material.specular_texture.texture,
            material.specular_color_texture.texture,
            material.clearcoat_texture.texture,
            material.clearcoat_roughness_texture.texture,
            material.anisotropy_texture.texture,
            material.sheen_color_texture.texture,
            material.sheen_roughness_texture.texture,
            material.iridescence_texture.texture,
            material.iridescence_thickness_texture.texture};
}

}  // namespace

Result<void> ModelPlacement::place(NodeId parent, const std::filesystem::path& path,
                                   std::optional<MaterialId> material) {
    std::vector<NodeId> placed;
    const std::filesystem::path key = path.lexically_normal();
    if (const auto known = models_.find(key); known != models_.end()) {
        placed = place_again(known->second, parent);
    } else {
        const std::uint64_t before = scene_.journal_end();
        const Result<NodeId> root = reader_(scene_, parent, path, warnings_);
        if (!root) return tl::unexpected<Error>(root.error());
        const Model& model = models_.emplace(key, describe(*root, before)).first->second;
        placed = model.first_nodes;
    }
    if (material) replace_material(placed, *material);
    return {};
}

ModelPlacement::Model ModelPlacement::describe(NodeId root, std::uint64_t since) const {
    Model model;
    model.first_nodes.push_back(root);
    model.parents.push_back(0);
    for (std::size_t i = 0; i < model.first_nodes.size(); ++i) {
        const Node* node = scene_.nodes().find(model.first_nodes[i]);
        if (!node) break;
        model.nodes.push_back(*node);
        for (const NodeId child : node->children()) {
            model.first_nodes.push_back(child);
            model.parents.push_back(i);
        }
    }
    scene_.changes_since(since, [&](const Change& change) {
        if (change.table != Change::Table::animation || change.aspects != Change::added) return;
        if (const Animation* animation = scene_.animations().at(change.index)) model.animations.push_back(*animation);
    });
    return model;
}

std::vector<NodeId> ModelPlacement::place_again(const Model& model, NodeId parent) {
    std::vector<NodeId> placed;
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
        placed.push_back(scene_.add_node(model.nodes[i], i == 0 ? parent : placed[model.parents[i]]));
    for (Animation animation : model.animations) {
        std::vector<AnimationChannel> channels;  // cameras and materials are shared and driven already
        for (AnimationChannel& channel : animation.channels) {
            const NodeId* target = std::get_if<NodeId>(&channel.target);
            if (!target) continue;
            const auto first = std::find(model.first_nodes.begin(), model.first_nodes.end(), *target);
            if (first == model.first_nodes.end()) continue;
            channel.target = placed[static_cast<std::size_t>(first - model.first_nodes.begin())];
            channels.push_back(std::move(channel));
        }
        animation.channels = std::move(channels);
        if (!animation.channels.empty()) scene_.add_animation(std::move(animation));
    }
    return placed;
}

void ModelPlacement::replace_material(const std::vector<NodeId>& nodes, MaterialId material) {
    for (const NodeId id : nodes) {
        const Node* node = scene_.nodes().find(id);
        if (!node || node->parts.empty()) continue;
        std::vector<Part> parts = node->parts;
        for (Part& part : parts) replaced_.push_back(std::exchange(part.material, material));
        scene_.set_parts(id, std::move(parts));
    }
}

void ModelPlacement::remove_replaced_materials() {
    std::set<MaterialId> candidates(replaced_.begin(), replaced_.end());
    scene_.nodes().each([&](NodeId, const Node& node) {
        for (const Part& part : node.parts) candidates.erase(part.material);
    });
    std::set<TextureId> textures;
    for (const MaterialId id : candidates) {
        const Material* material = scene_.materials().find(id);
        if (!material) continue;
        for (const TextureId texture : textures_of(*material)) textures.insert(texture);
        scene_.remove(id);
    }
    scene_.materials().each([&](MaterialId, const Material& material) {
        for (const TextureId texture : textures_of(material)) textures.erase(texture);
    });
    textures.erase(scene_.sky().image);
    for (const TextureId texture : textures) scene_.remove(texture);
}

}  // namespace heliodon::scene_file
