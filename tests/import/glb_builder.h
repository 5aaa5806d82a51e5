#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "import/import.h"

namespace heliodon::tests {

using Json = nlohmann::json;

/// A folder that goes away with the test.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "heliodon-import-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
    std::filesystem::path write(std::string_view name, std::string_view bytes) const {
        std::ofstream(path_ / name, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

/// Builds a glTF document with one binary buffer.
class GlbBuilder {
public:
    GlbBuilder() {
        json = {
            {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    }

    Json json;
    std::string binary;

    std::size_t add_view(std::string_view bytes) {
        while (binary.size() % 4 != 0) binary += '\0';
        json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
        binary += bytes;
        return json["bufferViews"].size() - 1;
    }
    template <class T>
    static std::string_view bytes_of(const std::vector<T>& values) {
        return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
    }
    template <class T>
    std::size_t add_accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
        const std::size_t width = type == "SCALAR" ? 1 : std::size_t(type[3] - '0');
        Json accessor = {{"bufferView", add_view(bytes_of(values))},
                         {"componentType", component_type<T>()},
                         {"count", values.size() / width},
                         {"type", type}};
        if (normalized) accessor["normalized"] = true;
        json["accessors"].push_back(accessor);
        return json["accessors"].size() - 1;
    }
    template <class T>
    static int component_type() {
        if (std::is_same_v<T, std::int8_t>) return 5120;
        if (std::is_same_v<T, std::uint8_t>) return 5121;
        if (std::is_same_v<T, std::int16_t>) return 5122;
        if (std::is_same_v<T, std::uint16_t>) return 5123;
        if (std::is_same_v<T, std::uint32_t>) return 5125;
        return 5126;
    }
    /// A primitive of the first mesh.
    Json& add_primitive(const Json& primitive) {
        json["meshes"][0]["primitives"].push_back(primitive);
        return json["meshes"][0]["primitives"].back();
    }
    /// A unit square in the xy plane facing +z, two triangles, with texture coordinates.
    Json& add_square(const Json& more = Json::object()) {
        Json primitive = {{"attributes",
                           {{"POSITION", add_accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3")},
                            {"NORMAL", add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")},
                            {"TEXCOORD_0", add_accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2")}}},
                          {"indices", add_accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR")}};
        primitive.update(more);
        return add_primitive(primitive);
    }

    [[nodiscard]] std::string glb() const {
        Json document = json;
        if (!binary.empty() && !document.contains("buffers")) document["buffers"] = {{{"byteLength", binary.size()}}};
        std::string text = document.dump(), data = binary;
        while (text.size() % 4 != 0) text += ' ';
        while (data.size() % 4 != 0) data += '\0';
        std::string file = "glTF" + word(2) + word(12 + 8 + text.size() + (data.empty() ? 0 : 8 + data.size()));
        file += word(text.size()) + "JSON" + text;
        if (!data.empty()) file += word(data.size()) + std::string("BIN\0", 4) + data;
        return file;
    }
    /// The file through the importer; an error stands in `error`.
    [[nodiscard]] bool load(Scene& scene, std::string* error = nullptr) {
        const TemporaryFolder folder;
        const auto root = import_model(scene, {}, folder.write("model.glb", glb()), warnings);
        if (!root && error) *error = root.error().text();
        return root.has_value();
    }
    [[nodiscard]] bool warned(std::string_view text) const {
        for (const Error& warning : warnings)
            if (warning.message.find(text) != std::string::npos) return true;
        return false;
    }
    Warnings warnings;

private:
    static std::string word(std::size_t value) {
        std::string bytes(4, '\0');
        for (int i = 0; i < 4; ++i) bytes[std::size_t(i)] = char(value >> (8 * i) & 255);
        return bytes;
    }
};

template <class Slots>
const auto& first(const Slots& slots) {
    return *slots.at(0);
}

}  // namespace heliodon::tests
