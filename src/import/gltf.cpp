#include "import/gltf.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cmath>
#include <utility>

#include "import/import_model.h"

namespace heliodon::import::gltf {
namespace {

/// Rotation, scale and translation of a matrix without shear; nothing where it has any.
std::optional<Transform> decompose(const glm::mat4& matrix) {
    Transform transform;
    transform.translation = glm::vec3(matrix[3]);
    glm::mat3 rotation(matrix);
    for (int c = 0; c < 3; ++c) {
        transform.scale[c] = glm::length(rotation[c]);
        if (!(transform.scale[c] > 0)) return std::nullopt;
        rotation[c] /= transform.scale[c];
    }
    // Columns this far from a right angle are what single-precision exporters leave of a pure rotation.
    constexpr float shear = 1e-5f;
    if (std::abs(glm::dot(rotation[0], rotation[1])) > shear || std::abs(glm::dot(rotation[1], rotation[2])) > shear ||
        std::abs(glm::dot(rotation[2], rotation[0])) > shear)
        return std::nullopt;
    if (glm::determinant(rotation) < 0) {
        transform.scale.x = -transform.scale.x;
        rotation[0] = -rotation[0];
    }
    transform.rotation = glm::normalize(glm::quat_cast(rotation));
    return transform;
}

template <int Length>
glm::vec<Length, float> vector(const std::vector<double>& values) {
    glm::vec<Length, float> result(0);
    for (int i = 0; i < Length; ++i) result[i] = float(values[std::size_t(i)]);
    return result;
}

void set_transform(const Document& document, const tinygltf::Node& source, const std::string& at, Node& node) {
    if (source.matrix.size() == 16) {
        glm::mat4 matrix(1.0f);
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = float(source.matrix[std::size_t(i)]);
        for (int i = 0; i < 16; ++i)
            if (!std::isfinite(matrix[i / 4][i % 4])) document.refuse(at + ".matrix", "expected finite numbers");
        if (const auto transform = decompose(matrix))
            node.transform = *transform;
        else
            node.matrix = matrix;
        return;
    }
    if (source.translation.size() == 3) node.transform.translation = vector<3>(source.translation);
    if (source.scale.size() == 3) node.transform.scale = vector<3>(source.scale);
    if (source.rotation.size() == 4) {
        const glm::vec4 q = vector<4>(source.rotation);
        const float length = glm::length(q);
        if (!(length > 0)) document.refuse(at + ".rotation", "expected a quaternion, found one of length 0");
        node.transform.rotation = glm::quat(q.w, q.x, q.y, q.z) / length;
    }
    const glm::vec3 sum = node.transform.translation + node.transform.scale;
    if (!std::isfinite(sum.x + sum.y + sum.z)) document.refuse(at, "expected finite numbers in translation and scale");
}

/// The roots of the default scene; of the only or first one where none is named; every root without any.
std::vector<std::size_t> scene_roots(const Document& document, const tinygltf::Model& model) {
    std::vector<std::size_t> roots;
    if (!model.scenes.empty()) {
        const std::size_t scene = model.defaultScene >= 0 ? std::size_t(model.defaultScene) : 0;
        for (const int node : model.scenes[scene].nodes) roots.push_back(std::size_t(node));
        return roots;
    }
    std::vector<char> has_parent(document.count("nodes"), 0);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children) has_parent[std::size_t(child)] = 1;
    for (std::size_t i = 0; i < has_parent.size(); ++i)
        if (!has_parent[i]) roots.push_back(i);
    return roots;
}

/// Everything read, before anything is added to the scene, so that a refused file leaves the scene as it was.
struct Drafts {
    std::vector<MaterialDraft> materials;
    std::vector<MeshDraft> meshes;
    std::vector<Texture> textures;
    std::vector<Light> lights;
};

class SceneBuilder {
public:
    SceneBuilder(const tinygltf::Model& model, Scene& scene) : model_(model), scene_(scene) {}

    void add_resources(Drafts& drafts) {
        std::vector<TextureId> textures;
        for (Texture& texture : drafts.textures) textures.push_back(scene_.add_texture(std::move(texture)));
        std::vector<MaterialId> materials;
        for (MaterialDraft& draft : drafts.materials) {
            for (const MaterialDraft::Slot& slot : draft.slots)
                (draft.material.*slot.use).texture = textures[std::size_t(slot.texture)];
            materials.push_back(scene_.add_material(std::move(draft.material)));
        }
        for (MeshDraft& mesh : drafts.meshes) {
            std::vector<Part>& parts = parts_.emplace_back();
            for (PrimitiveDraft& primitive : mesh)
                parts.push_back({scene_.add_geometry(std::move(primitive.geometry)),
                                 primitive.material ? materials[*primitive.material] : MaterialId{}});
        }
    }

    /// Adds the nodes below `root`, without recursion: files may nest as deep as they like.
    std::vector<NodeId> add_nodes(NodeId root, const std::vector<std::size_t>& roots, const std::vector<Node>& nodes) {
        std::vector<NodeId> ids(nodes.size());
        std::vector<std::pair<std::size_t, NodeId>> waiting;
        for (auto node = roots.rbegin(); node != roots.rend(); ++node) waiting.push_back({*node, root});
        while (!waiting.empty()) {
            const auto [index, parent] = waiting.back();
            waiting.pop_back();
            Node node = nodes[index];
            if (const int mesh = model_.nodes[index].mesh; mesh >= 0) node.parts = parts_[std::size_t(mesh)];
            ids[index] = scene_.add_node(std::move(node), parent);
            const std::vector<int>& children = model_.nodes[index].children;
            for (auto child = children.rbegin(); child != children.rend(); ++child)
                waiting.push_back({std::size_t(*child), ids[index]});
        }
        return ids;
    }

private:
    const tinygltf::Model& model_;
    Scene& scene_;
    std::vector<std::vector<Part>> parts_;
};

std::vector<Node> read_nodes(const Document& document, const tinygltf::Model& model, const std::vector<Light>& lights) {
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const std::string at = fmt::format("$.nodes[{}]", i);
        Node node;
        node.name = model.nodes[i].name.empty() ? fmt::format("node {}", i) : model.nodes[i].name;
        set_transform(document, model.nodes[i], at, node);
        if (const Json* punctual = extension(document.json()["nodes"][i], "KHR_lights_punctual")) {
            const std::string inside = at + ".extensions.KHR_lights_punctual";
            const std::size_t light = unsigned_member(document, *punctual, "light", {}, inside);
            if (light >= lights.size())
                document.refuse(inside + ".light",
                                fmt::format("index {} is out of range: there are {} lights", light, lights.size()));
            node.light = lights[light];
        }
        nodes.push_back(std::move(node));
    }
    return nodes;
}

}  // namespace
}  // namespace heliodon::import::gltf

namespace heliodon::import {

NodeId import_gltf(Scene& scene, NodeId parent, const std::filesystem::path& path, Warnings& warnings) {
    using namespace gltf;
    Document document(path, warnings);
    tinygltf::Model model;
    read_model(document, model);
    Drafts drafts;
    TextureSet texture_set;
    drafts.lights = read_lights(document);
    drafts.materials = read_materials(document, model, texture_set, warnings);
    drafts.meshes = read_meshes(document, drafts.materials, warnings);
    drafts.textures = texture_set.build();
    const std::vector<Node> nodes = read_nodes(document, model, drafts.lights);
    if (document.count("skins") > 0) warnings.push_back({path.string(), "ignores skins: meshes keep their rest pose"});
    std::vector<AnimationDraft> animations = read_animations(document, model, warnings);
    const std::vector<std::optional<Camera>> cameras = read_cameras(document, model, warnings);
    document.release_bytes();

    SceneBuilder builder(model, scene);
    builder.add_resources(drafts);
    Node root;
    root.name = path.stem().string();
    const NodeId root_id = scene.add_node(std::move(root), parent);
    const std::vector<NodeId> ids = builder.add_nodes(root_id, scene_roots(document, model), nodes);
    add_animations(std::move(animations), ids, scene);
    add_cameras(cameras, model, ids, scene);
    return root_id;
}

}  // namespace heliodon::import
