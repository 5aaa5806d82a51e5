#pragma once

#include <vector>

#include "import/gltf_document.h"
#include "import/texture_set.h"
#include "scene/scene.h"

namespace tinygltf {
class Model;
}

namespace heliodon::import::gltf {

/// A material before its textures exist: which slot will use which texture of the set.
struct MaterialDraft {
    Material material;
    struct Slot {
        TextureUse Material::*use;
        int texture;
    };
    std::vector<Slot> slots;
    [[nodiscard]] bool needs_tangents() const;
    [[nodiscard]] int normal_texcoord() const;
};

/// One primitive of a glTF mesh that holds triangles.
struct PrimitiveDraft {
    Geometry geometry;
    std::optional<std::size_t> material;
};
using MeshDraft = std::vector<PrimitiveDraft>;

/// The scene-describing half of the document, read by tinygltf.
void read_model(const Document& document, tinygltf::Model& model);

[[nodiscard]] std::vector<MaterialDraft> read_materials(const Document& document, const tinygltf::Model& model,
                                                        TextureSet& textures, Warnings& warnings);
[[nodiscard]] std::vector<MeshDraft> read_meshes(const Document& document, const std::vector<MaterialDraft>& materials,
                                                 Warnings& warnings);

/// A primitive's attributes and indices as KHR_draco_mesh_compression holds them; attributes that draco does
/// not hold stay empty.
struct DracoPrimitive {
    std::size_t vertex_count = 0;
    PaddedArray<std::uint32_t> indices;
    struct Attribute {
        std::string name;
        int components = 0;
        std::vector<float> values;
    };
    std::vector<Attribute> attributes;
};
[[nodiscard]] DracoPrimitive decode_draco(const Document& document, const Json& primitive,
                                          const std::string& json_path);

[[nodiscard]] std::vector<Light> read_lights(const Document& document);

/// Perspective cameras with their lens; empty for those that are not read.
[[nodiscard]] std::vector<std::optional<Camera>> read_cameras(const Document& document, const tinygltf::Model& model,
                                                              Warnings& warnings);
/// Adds a camera at the world transform of each node that carries one.
void add_cameras(const std::vector<std::optional<Camera>>& cameras, const tinygltf::Model& model,
                 const std::vector<NodeId>& nodes, Scene& scene);

/// An animation whose channels drive nodes by their number in the file.
struct AnimationDraft {
    Animation animation;
    std::vector<std::size_t> target_nodes;  ///< one a channel
};
[[nodiscard]] std::vector<AnimationDraft> read_animations(const Document& document, const tinygltf::Model& model,
                                                          Warnings& warnings);
/// Adds them with their nodes' handles; channels of nodes outside the scene are left out.
void add_animations(std::vector<AnimationDraft> drafts, const std::vector<NodeId>& nodes, Scene& scene);

}  // namespace heliodon::import::gltf
