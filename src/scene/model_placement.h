#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "scene/scene_file.h"

namespace heliodon::scene_file {

/// Puts models below nodes. A file that several nodes name is read once: the others get nodes that share its
/// geometry.
class ModelPlacement {
public:
    ModelPlacement(Scene& scene, const ModelReader& reader, Warnings& warnings)
        : scene_(scene), reader_(reader), warnings_(warnings) {}

    /// `material` replaces the material of every part of the model.
    [[nodiscard]] Result<void> place(NodeId parent, const std::filesystem::path& path,
                                     std::optional<MaterialId> material);
    /// Removes the materials that were replaced everywhere, and the textures that only they used.
    void remove_replaced_materials();

private:
    struct Model {
        std::vector<Node> nodes;           ///< parents before children
        std::vector<NodeId> first_nodes;   ///< the same of the first placement
        std::vector<std::size_t> parents;  ///< index into `nodes`; the root's is unused
        std::vector<Animation> animations;
    };
    [[nodiscard]] Model describe(NodeId root, std::uint64_t since) const;
    [[nodiscard]] std::vector<NodeId> place_again(const Model& model, NodeId parent);
    void replace_material(const std::vector<NodeId>& nodes, MaterialId material);

    Scene& scene_;
    const ModelReader& reader_;
    Warnings& warnings_;
    std::map<std::filesystem::path, Model> models_;
    std::vector<MaterialId> replaced_;
};

}  // namespace heliodon::scene_file
