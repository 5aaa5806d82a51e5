#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "import/gltf.h"
#include "import/mesh_completion.h"

namespace heliodon::import::gltf {
namespace {

constexpr std::size_t mode_triangles = 4, mode_strip = 5, mode_fan = 6;

/// What happened to the meshes, told once for the whole file.
struct Tally {
    std::size_t degenerate = 0, normals_replaced = 0, not_triangles = 0;
    bool morph_targets = false, third_texcoord = false, flat_normals = false, second_colors = false;
};

class PrimitiveReader {
public:
    PrimitiveReader(const Document& document, const Json& primitive, std::string at)
        : document_(document), primitive_(primitive), at_(std::move(at)) {
        if (extension(primitive, "KHR_draco_mesh_compression")) draco_ = decode_draco(document, primitive, at_);
        const auto position = attribute_accessor("POSITION");
        if (!position) document.refuse(at_ + ".attributes", "expected POSITION");
        if (!draco_) document.expect_affordable(*position, at_ + ".attributes.POSITION");
        vertex_count_ = draco_ ? draco_->vertex_count : document.accessor(*position).count;
    }

    [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }
    [[nodiscard]] bool has(const char* name) const { return primitive_["attributes"].contains(name); }

    /// The attribute as vectors of `Vector`'s width; empty when the primitive lacks it. `least` and `most`
    /// components are accepted.
    template <class Vector>
    PaddedArray<Vector> read(const char* name, int least, int most) const {
        PaddedArray<Vector> result;
        const auto accessor = attribute_accessor(name);
        if (!accessor) return result;
        const std::string path = fmt::format("{}.attributes.{}", at_, name);
        constexpr int width = int(sizeof(Vector) / sizeof(float));
        if (const DracoPrimitive::Attribute* attribute = draco_attribute(name)) {
            check_width(attribute->components, least, most, path);
            result.resize(vertex_count_);
            for (std::size_t i = 0; i < vertex_count_; ++i)
                for (int c = 0; c < width; ++c) {
                    const float missing = c == 3 ? 1.0f : 0.0f;
                    result[i][c] =
                        c < attribute->components ? attribute->values[i * attribute->components + c] : missing;
                    if (!std::isfinite(result[i][c]))
                        document_.refuse(path, fmt::format("element {} is not finite", i));
                }
            return result;
        }
        const Accessor& source = document_.accessor(*accessor);
        check_width(source.components, least, most, path);
        if (source.count != vertex_count_)
            document_.refuse(path, fmt::format("has {} elements, POSITION has {}", source.count, vertex_count_));
        result.resize(vertex_count_);
        document_.read_floats(*accessor, width, &result[0][0], path);
        return result;
    }

    /// A list of triangles, whatever the primitive's mode.
    [[nodiscard]] PaddedArray<std::uint32_t> triangles(std::size_t mode) {
        PaddedArray<std::uint32_t> indices;
        if (draco_) {
            indices = std::move(draco_->indices);
            mode = mode_triangles;  // draco holds triangles; STRIP only says how the file was made
        } else if (const auto accessor = index_member(document_, primitive_, "indices", "accessors", at_)) {
            const Accessor& source = document_.accessor(*accessor);
            const bool good = source.components == 1 && !source.normalized &&
                              (source.type == ComponentType::u8 || source.type == ComponentType::u16 ||
                               source.type == ComponentType::u32);
            if (!good) document_.refuse(at_ + ".indices", "expected scalars of unsigned bytes, shorts or ints");
            indices = document_.read_indices(*accessor);
        } else {
            indices.resize(vertex_count_);
            for (std::size_t i = 0; i < vertex_count_; ++i) indices[i] = std::uint32_t(i);
        }
        for (std::size_t i = 0; i < indices.size(); ++i)
            if (indices[i] >= vertex_count_)
                document_.refuse(at_ + ".indices", fmt::format("index {} at {} is out of range: there are {} vertices",
                                                               indices[i], i, vertex_count_));
        if (mode != mode_triangles) return unrolled(indices, mode);
        if (indices.size() % 3 != 0)
            document_.refuse(at_ + ".indices",
                             fmt::format("expected whole triangles, found {} indices", indices.size()));
        return indices;
    }

private:
    std::optional<std::size_t> attribute_accessor(const char* name) const {
        return index_member(document_, primitive_["attributes"], name, "accessors", at_ + ".attributes");
    }
    const DracoPrimitive::Attribute* draco_attribute(const char* name) const {
        if (!draco_) return nullptr;
        for (const auto& attribute : draco_->attributes)
            if (attribute.name == name) return &attribute;
        return nullptr;
    }
    void check_width(int components, int least, int most, const std::string& path) const {
        if (components < least || components > most)
            document_.refuse(path, fmt::format("expected {} to {} components, found {}", least, most, components));
    }
    /// glTF 2.0, section 3.7.2.1: p_i = {v_i, v_(i+1+i%2), v_(i+2−i%2)} for strips, {v_(i+1), v_(i+2), v_0} for fans.
    static PaddedArray<std::uint32_t> unrolled(const PaddedArray<std::uint32_t>& source, std::size_t mode) {
        PaddedArray<std::uint32_t> result;
        for (std::size_t i = 0; i + 2 < source.size(); ++i) {
            if (mode == mode_strip)
                result.insert(result.end(), {source[i], source[i + 1 + i % 2], source[i + 2 - i % 2]});
            else
                result.insert(result.end(), {source[i + 1], source[i + 2], source[0]});
        }
        return result;
    }

    const Document& document_;
    const Json& primitive_;
    std::string at_;
    std::optional<DracoPrimitive> draco_;
    std::size_t vertex_count_ = 0;
};

bool all_white(const PaddedArray<glm::vec4>& colors) {
    return std::all_of(colors.begin(), colors.end(), [](const glm::vec4& color) { return color == glm::vec4(1); });
}

void read_attributes(const PrimitiveReader& reader, const MaterialDraft* material, Mesh& mesh, Tally& tally) {
    mesh.positions = reader.read<glm::vec3>("POSITION", 3, 3);
    mesh.normals = reader.read<glm::vec3>("NORMAL", 3, 3);
    mesh.texcoords[0] = reader.read<glm::vec2>("TEXCOORD_0", 2, 2);
    mesh.texcoords[1] = reader.read<glm::vec2>("TEXCOORD_1", 2, 2);
    mesh.colors = reader.read<glm::vec4>("COLOR_0", 3, 4);
    if (all_white(mesh.colors)) mesh.colors = {};
    // Without normals the file's tangents are to be ignored (glTF 2.0, section 3.7.2.1).
    if (material && material->needs_tangents() && !mesh.normals.empty())
        mesh.tangents = reader.read<glm::vec4>("TANGENT", 4, 4);
    tally.third_texcoord |= reader.has("TEXCOORD_2");
    tally.second_colors |= reader.has("COLOR_1");
}

void complete(const MaterialDraft* material, Mesh& mesh, Tally& tally) {
    tally.degenerate += drop_degenerate_triangles(mesh);
    drop_unused_vertices(mesh);
    if (mesh.indices.empty()) return;
    if (mesh.normals.empty()) {
        make_normals(mesh, 0.0f);
        tally.flat_normals = true;
    }
    tally.normals_replaced += repair_normals(mesh);
    for (glm::vec4& tangent : mesh.tangents) {
        const glm::dvec3 along(tangent);
        const double length = glm::length(along);
        if (length < 1e-6) {
            mesh.tangents = {};
            break;
        }
        tangent = glm::vec4(glm::vec3(along / length), tangent.w < 0 ? -1.0f : 1.0f);
    }
    if (material && material->needs_tangents() && mesh.tangents.empty())
        make_tangents(mesh, material->normal_texcoord());
}

void tell(const Document& document, const Tally& tally, Warnings& warnings) {
    const auto say = [&](bool happened, std::string text) {
        if (happened) warnings.push_back({document.path().string(), std::move(text)});
    };
    say(tally.degenerate > 0, fmt::format("drops {} triangles without area", tally.degenerate));
    say(tally.normals_replaced > 0, fmt::format("replaces {} normals without length", tally.normals_replaced));
    say(tally.flat_normals, "makes flat normals where a mesh has none");
    say(tally.not_triangles > 0, fmt::format("ignores {} primitives of points or lines", tally.not_triangles));
    say(tally.morph_targets, "ignores morph targets");
    say(tally.third_texcoord, "ignores texture coordinates past the second set");
    say(tally.second_colors, "ignores vertex colours past the first set");
}

}  // namespace

std::vector<MeshDraft> read_meshes(const Document& document, const std::vector<MaterialDraft>& materials,
                                   Warnings& warnings) {
    std::vector<MeshDraft> meshes(document.count("meshes"));
    Tally tally;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const Json& json = document.json()["meshes"][m];
        for (std::size_t p = 0; p < json["primitives"].size(); ++p) {
            const Json& primitive = json["primitives"][p];
            const std::string at = fmt::format("$.meshes[{}].primitives[{}]", m, p);
            tally.morph_targets |= primitive.contains("targets");
            const std::size_t mode = unsigned_member(document, primitive, "mode", mode_triangles, at);
            if (mode < mode_triangles || mode > mode_fan) {
                ++tally.not_triangles;
                continue;
            }
            PrimitiveDraft draft;
            draft.material = index_member(document, primitive, "material", "materials", at);
            const MaterialDraft* material = draft.material ? &materials[*draft.material] : nullptr;
            PrimitiveReader reader(document, primitive, at);
            Mesh& mesh = draft.geometry.mesh;
            read_attributes(reader, material, mesh, tally);
            mesh.indices = reader.triangles(mode);
            complete(material, mesh, tally);
            if (mesh.indices.empty()) continue;
            draft.geometry.name = json.value("name", fmt::format("mesh {}", m));
            if (json["primitives"].size() > 1) draft.geometry.name += fmt::format(" {}", p);
            draft.geometry.bounds = mesh.bounds();
            meshes[m].push_back(std::move(draft));
        }
    }
    tell(document, tally, warnings);
    return meshes;
}

}  // namespace heliodon::import::gltf
