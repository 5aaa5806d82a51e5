#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <istream>
#include <unordered_map>
#include <utility>

#include "core/image_io.h"
#include "import/import_failure.h"
#include "import/import_model.h"
#include "import/mesh_completion.h"
#include "import/obj_text.h"
#include "import/polygon.h"

#define TINYOBJLOADER_IMPLEMENTATION
#include "import/obj_materials.h"

namespace heliodon::import {
namespace {

struct Corner {
    int position = -1, texcoord = -1, normal = -1;
    bool operator==(const Corner&) const = default;
};
struct CornerHash {
    std::size_t operator()(const Corner& c) const {
        std::size_t hash = std::size_t(unsigned(c.position)) * 0x9e3779b97f4a7c15ull;
        hash ^= (std::size_t(unsigned(c.texcoord)) + (hash >> 29)) * 0xbf58476d1ce4e5b9ull;
        return hash ^ (std::size_t(unsigned(c.normal)) + (hash >> 32)) * 0x94d049bb133111ebull;
    }
};

/// The triangles of one object that share a material.
struct Group {
    std::string object, material;
    std::vector<Corner> corners;  ///< distinct ones: the vertices to be
    std::unordered_map<Corner, std::uint32_t, CornerHash> numbers;
    PaddedArray<std::uint32_t> indices;
    bool lacks_normals = false, lacks_texcoords = false;
};

class ObjFile {
public:
    ObjFile(const std::filesystem::path& path, Warnings& warnings)
        : path_(path), materials_(path.parent_path(), warnings) {}

    void read() {
        Result<std::string> text = read_file(path_);
        if (!text) throw ImportFailure(text.error());
        LineStream lines(*text, [this](std::string_view line, int) { check(line); });
        lines_ = &lines;
        tinyobj::callback_t callback;
        callback.vertex_cb = [](void* self, float x, float y, float z, float) {
            of(self).positions_.push_back({x, y, z});
        };
        callback.normal_cb = [](void* self, float x, float y, float z) { of(self).normals_.push_back({x, y, z}); };
        callback.texcoord_cb = [](void* self, float x, float y, float) { of(self).texcoords_.push_back({x, 1 - y}); };
        callback.index_cb = [](void* self, tinyobj::index_t* indices, int count) {
            of(self).add_face({indices, std::size_t(count)});
        };
        callback.usemtl_cb = [](void* self, const char* name, int) { of(self).use_material(name); };
        callback.object_cb = [](void* self, const char* name) { of(self).begin_object(name); };
        std::istream stream(&lines);
        stream.exceptions(std::ios::badbit);  // what a line is refused for passes through the stream
        std::string warning, error;
        tinyobj::LoadObjWithCallback(stream, callback, this, &materials_, &warning, &error);
        lines_ = nullptr;
        if (groups_.empty()) refuse(path_.string(), "expected faces, found none");
    }

    [[nodiscard]] const MtlReader& materials() const { return materials_; }
    [[nodiscard]] std::vector<Group>& groups() { return groups_; }
    [[nodiscard]] bool ignored_lines() const { return ignored_lines_; }

    /// The group's vertices; its corners are freed.
    [[nodiscard]] Mesh take_mesh(Group& group) const {
        Mesh mesh;
        const std::size_t count = group.corners.size();
        mesh.positions.resize(count);
        if (!group.lacks_normals) mesh.normals.resize(count);
        if (!group.lacks_texcoords) mesh.texcoords[0].resize(count);
        if (!colors_.empty()) mesh.colors.resize(count, glm::vec4(1));
        for (std::size_t i = 0; i < count; ++i) {
            const Corner& corner = group.corners[i];
            mesh.positions[i] = positions_[std::size_t(corner.position)];
            if (!group.lacks_normals) mesh.normals[i] = normals_[std::size_t(corner.normal)];
            if (!group.lacks_texcoords) mesh.texcoords[0][i] = texcoords_[std::size_t(corner.texcoord)];
            if (std::size_t(corner.position) < colors_.size()) mesh.colors[i] = colors_[std::size_t(corner.position)];
        }
        mesh.indices = std::move(group.indices);
        group.corners = {};
        return mesh;
    }

private:
    static ObjFile& of(void* self) { return *static_cast<ObjFile*>(self); }
    [[noreturn]] void complain(const std::string& message) const {
        refuse(fmt::format("{}:{}", path_.string(), lines_ ? lines_->line() : 0), message);
    }

    /// Refuses what tinyobjloader would silently read as 0.
    void check(std::string_view line) {
        const std::vector<std::string_view> words = words_of(line.substr(0, line.find('#')));
        if (words.empty()) return;
        if (words[0] == "v" || words[0] == "vn" || words[0] == "vt") check_numbers(words);
        if (words[0] == "f") check_face(words);
        ignored_lines_ |= words[0] == "l" || words[0] == "p";
    }
    void check_numbers(const std::vector<std::string_view>& words) {
        const std::size_t least = words[0] == "vt" ? 1 : 3;
        if (words.size() - 1 < least)
            complain(fmt::format("expected {} numbers after {}, found {}", least, words[0], words.size() - 1));
        std::array<float, 7> numbers{};
        for (std::size_t i = 1; i < words.size(); ++i) {
            const std::optional<float> number = finite_number(words[i]);
            if (!number) complain(fmt::format("expected a finite number, found \"{}\"", words[i]));
            if (i <= numbers.size()) numbers[i - 1] = *number;
        }
        // Six numbers are a place and a colour, the common extension that tinyobjloader's callbacks leave out.
        if (words[0] == "v" && words.size() == 7) {
            colors_.resize(positions_.size(), glm::vec4(1));
            colors_.push_back({numbers[3], numbers[4], numbers[5], 1});
        }
    }
    void check_face(const std::vector<std::string_view>& words) const {
        if (words.size() < 4) complain(fmt::format("expected at least 3 corners, found {}", words.size() - 1));
        for (std::size_t i = 1; i < words.size(); ++i) {
            std::string_view word = words[i];
            for (int part = 0; part < 3; ++part) {
                const std::string_view digits = word.substr(0, word.find('/'));
                int value = 0;
                const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
                const bool number = error == std::errc() && end == digits.data() + digits.size() && value != 0;
                if (!number && !(part == 1 && digits.empty()))
                    complain(fmt::format(
                        "expected a corner such as 1, 1/2, 1//3 or 1/2/3 with indices from 1 on, found \"{}\"",
                        words[i]));
                if (digits.size() == word.size()) break;
                if (part == 2) complain(fmt::format("expected at most three indices a corner, found \"{}\"", words[i]));
                word.remove_prefix(digits.size() + 1);
            }
        }
    }

    /// OBJ counts from 1, and from the end with negative numbers; 0 stands for none.
    int resolve(int index, std::size_t count, const char* what) const {
        if (index == 0) return -1;
        const std::int64_t resolved = index > 0 ? std::int64_t(index) - 1 : std::int64_t(count) + index;
        if (resolved < 0 || resolved >= std::int64_t(count))
            complain(fmt::format("{} index {} is out of range: {} are given so far", what, index, count));
        return int(resolved);
    }

    Group& group() {
        if (current_ < groups_.size()) return groups_[current_];
        for (current_ = 0; current_ < groups_.size(); ++current_)
            if (groups_[current_].object == object_ && groups_[current_].material == material_)
                return groups_[current_];
        groups_.push_back({.object = object_, .material = material_});
        return groups_.back();
    }
    void use_material(std::string_view name) {
        while (!name.empty() && (name.back() == ' ' || name.back() == '\t')) name.remove_suffix(1);
        material_ = name;
        current_ = std::size_t(-1);
    }
    void begin_object(std::string_view name) {
        object_ = name;
        current_ = std::size_t(-1);
    }

    void add_face(std::span<const tinyobj::index_t> face) {
        polygon_.clear();
        corners_.clear();
        for (const tinyobj::index_t& index : face) {
            corners_.push_back({resolve(index.vertex_index, positions_.size(), "vertex"),
                                resolve(index.texcoord_index, texcoords_.size(), "texture coordinate"),
                                resolve(index.normal_index, normals_.size(), "normal")});
            if (corners_.back().position < 0) complain("vertex index 0 is out of range");
            polygon_.push_back(positions_[std::size_t(corners_.back().position)]);
        }
        Group& to = group();
        for (const std::uint32_t k : triangulate(polygon_)) {
            const Corner& corner = corners_[k];
            const auto [at, is_new] = to.numbers.try_emplace(corner, std::uint32_t(to.corners.size()));
            if (is_new) {
                to.corners.push_back(corner);
                to.lacks_normals |= corner.normal < 0;
                to.lacks_texcoords |= corner.texcoord < 0;
            }
            to.indices.push_back(at->second);
        }
    }

    std::filesystem::path path_;
    MtlReader materials_;
    const LineStream* lines_ = nullptr;
    std::vector<glm::vec3> positions_, normals_;
    std::vector<glm::vec2> texcoords_;
    std::vector<glm::vec4> colors_;
    std::vector<Group> groups_;
    std::string object_, material_;
    std::size_t current_ = std::size_t(-1);
    bool ignored_lines_ = false;
    std::vector<glm::vec3> polygon_;
    std::vector<Corner> corners_;
};

/// What the OBJ file becomes, before the scene is touched.
struct Draft {
    std::string object;
    Geometry geometry;
    std::size_t material = std::size_t(-1);
};

std::vector<Draft> complete_groups(ObjFile& file, const ObjMaterials& materials, const std::filesystem::path& path,
                                   Warnings& warnings) {
    std::vector<Draft> drafts;
    std::size_t degenerate = 0;
    bool made_normals = false;
    for (Group& group : file.groups()) {
        group.numbers = {};
        Draft draft{.object = group.object, .geometry = {}};
        for (std::size_t i = 0; i < materials.materials.size(); ++i)
            if (materials.materials[i].name == group.material) draft.material = i;
        if (!group.material.empty() && draft.material == std::size_t(-1))
            warnings.push_back(
                {path.string(),
                 fmt::format("material \"{}\" is not in any .mtl file; the default one is taken", group.material)});
        Mesh mesh = file.take_mesh(group);
        degenerate += drop_degenerate_triangles(mesh);
        drop_unused_vertices(mesh);
        if (mesh.indices.empty()) continue;
        if (mesh.normals.empty()) {
            make_normals(mesh, crease_angle_rad);
            made_normals = true;
        }
        repair_normals(mesh);
        const bool bumpy =
            draft.material != std::size_t(-1) &&
            std::any_of(materials.slots[draft.material].begin(), materials.slots[draft.material].end(),
                        [](const auto& slot) {
                            return slot.first == &Material::normal_texture || slot.first == &Material::bump_texture;
                        });
        if (bumpy) make_tangents(mesh, 0);
        draft.geometry.name = group.object.empty() ? path.stem().string() : group.object;
        if (!group.material.empty()) draft.geometry.name += " " + group.material;
        draft.geometry.bounds = mesh.bounds();
        draft.geometry.mesh = std::move(mesh);
        drafts.push_back(std::move(draft));
    }
    if (degenerate > 0) warnings.push_back({path.string(), fmt::format("drops {} triangles without area", degenerate)});
    if (made_normals)
        warnings.push_back({path.string(), "makes smooth normals with creases at 60° where the file has none"});
    if (file.ignored_lines()) warnings.push_back({path.string(), "ignores points and lines"});
    return drafts;
}

}  // namespace

NodeId import_obj(Scene& scene, NodeId parent, const std::filesystem::path& path, Warnings& warnings) {
    std::vector<Draft> drafts;
    ObjMaterials materials;
    {
        ObjFile file(path, warnings);
        file.read();
        materials = read_obj_materials(file.materials(), path, warnings);
        drafts = complete_groups(file, materials, path, warnings);
    }
    std::vector<TextureId> textures;
    for (Texture& texture : materials.textures) textures.push_back(scene.add_texture(std::move(texture)));
    std::vector<MaterialId> material_ids;
    for (std::size_t i = 0; i < materials.materials.size(); ++i) {
        for (const auto& [slot, texture] : materials.slots[i])
            (materials.materials[i].*slot).texture = textures[std::size_t(texture)];
        material_ids.push_back(scene.add_material(std::move(materials.materials[i])));
    }
    Node root;
    root.name = path.stem().string();
    const NodeId root_id = scene.add_node(std::move(root), parent);
    // Groups of one object are found together; objects come in the order of the file.
    std::vector<std::pair<std::string, std::vector<Part>>> objects;
    for (Draft& draft : drafts) {
        auto object =
            std::find_if(objects.begin(), objects.end(), [&](const auto& o) { return o.first == draft.object; });
        if (object == objects.end()) object = objects.insert(objects.end(), {draft.object, {}});
        const MaterialId material = draft.material < material_ids.size() ? material_ids[draft.material] : MaterialId{};
        object->second.push_back({scene.add_geometry(std::move(draft.geometry)), material});
    }
    for (auto& [name, parts] : objects) {
        if (name.empty() || objects.size() == 1) {
            scene.set_parts(root_id, std::move(parts));
            continue;
        }
        Node node;
        node.name = name;
        node.parts = std::move(parts);
        scene.add_node(std::move(node), root_id);
    }
    return root_id;
}

}  // namespace heliodon::import
