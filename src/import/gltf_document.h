#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/padded_array.h"
#include "import/import_failure.h"

namespace heliodon::import::gltf {

using Json = nlohmann::json;
using Bytes = std::span<const std::uint8_t>;

/// A run of bytes with the distance between elements (0: tightly packed).
struct BufferView {
    Bytes bytes;
    std::size_t stride = 0;
};

enum class ComponentType : int { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };
[[nodiscard]] std::size_t size_of(ComponentType type);

/// An accessor that validation has found to lie inside its buffer views.
struct Accessor {
    std::size_t count = 0;
    int components = 1;
    ComponentType type = ComponentType::f32;
    bool normalized = false;
    bool has_values = false;  ///< false: zeros (a sparse accessor without buffer view, or draco's)
    Bytes bytes;
    std::size_t stride = 0;
    struct Sparse {
        std::size_t count = 0;
        ComponentType index_type = ComponentType::u32;
        Bytes indices, values;
    };
    std::optional<Sparse> sparse;
};

/// A glTF file: its JSON, checked whole, and its bytes. Everything that carries bytes (buffers, buffer
/// views, accessors, images) is read here, because tinygltf reads those without overflow checks, copies
/// every buffer and refuses accessors without a buffer view, which draco and sparse accessors have. What
/// describes the scene goes on to tinygltf (gltf_model.h).
class Document {
public:
    /// Reads a .gltf or .glb. Throws ImportFailure, located by file and JSON path.
    Document(const std::filesystem::path& path, Warnings& warnings);
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    [[nodiscard]] const Json& json() const { return json_; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// "file: $.json.path"
    [[nodiscard]] std::string where(std::string_view json_path) const;
    [[noreturn]] void refuse(std::string_view json_path, std::string message) const;
    /// Entries of a top-level array.
    [[nodiscard]] std::size_t count(const char* array) const;
    [[nodiscard]] const BufferView& view(std::size_t index) const { return views_[index]; }
    [[nodiscard]] const Accessor& accessor(std::size_t index) const { return accessors_[index]; }

    /// Refuses, in the name of `json_path`, an accessor that would take gigabytes of zeros without having any bytes.
    void expect_affordable(std::size_t index, std::string_view json_path) const;
    /// The accessor's elements as floats, `components` an element (the first ones of it, or padded with 0,
    /// the fourth with 1); integers are normalized where the accessor says so. Every value is finite or
    /// `json_path` is refused.
    void read_floats(std::size_t index, int components, float* out, std::string_view json_path) const;
    /// An index accessor's values.
    [[nodiscard]] PaddedArray<std::uint32_t> read_indices(std::size_t index) const;
    /// Bytes and name of an embedded picture, or the file it names.
    struct Picture {
        std::filesystem::path file;
        Bytes bytes;
    };
    [[nodiscard]] Picture picture(std::size_t image) const;

    /// Forgets buffers once geometry and pictures have been decoded.
    void release_bytes();

private:
    void split_container(Warnings& warnings);
    void parse_json(std::string_view text, std::size_t offset);
    void load_buffers();
    void load_views();
    void load_accessors();
    void load_data_pictures();
    [[nodiscard]] Bytes slice(Bytes bytes, const Json& object, std::string_view json_path) const;
    [[nodiscard]] std::vector<std::uint8_t> decode_data_uri(std::string_view uri, std::string_view json_path) const;
    [[nodiscard]] std::filesystem::path resolve(std::string_view uri) const;

    std::filesystem::path path_;
    std::string file_;  ///< the whole file
    Bytes binary_chunk_;
    bool has_binary_chunk_ = false;
    Json json_;
    std::vector<std::string> external_buffers_;
    std::vector<std::vector<std::uint8_t>> decoded_;  ///< data URIs and decompressed buffer views
    std::vector<Bytes> buffers_;
    std::vector<BufferView> views_;
    std::vector<Accessor> accessors_;
    std::vector<Picture> pictures_;
};

/// Checks everything that the rest of the reader relies on: types of members, indices in range, a tree of
/// nodes, extensions. Throws ImportFailure.
void validate(const Document& document, Warnings& warnings);

// Typed members of an object, with the JSON path in the message where the type is wrong.
[[nodiscard]] std::size_t unsigned_member(const Document& document, const Json& object, const char* key,
                                          std::optional<std::size_t> fallback, std::string_view json_path);
/// An index into the top-level array `array`; empty when the member is absent.
[[nodiscard]] std::optional<std::size_t> index_member(const Document& document, const Json& object, const char* key,
                                                      const char* array, std::string_view json_path);
/// The extension's object inside `object`, or null.
[[nodiscard]] const Json* extension(const Json& object, const char* name);

/// Decompresses one EXT_meshopt_compression buffer view.
[[nodiscard]] std::vector<std::uint8_t> decode_meshopt(const Document& document, const Json& extension, Bytes source,
                                                       std::string_view json_path);

}  // namespace heliodon::import::gltf
