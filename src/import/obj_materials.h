#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/result.h"
#include "import/material_files.h"
#include "scene/scene.h"

#include <tiny_obj_loader.h>

namespace heliodon::import {

/// The .mtl files of an OBJ file: what tinyobjloader reads, and which keys each material really has.
class MtlReader : public tinyobj::MaterialReader {
public:
    MtlReader(std::filesystem::path folder, Warnings& warnings) : folder_(std::move(folder)), warnings_(warnings) {}
    bool operator()(const std::string& file, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* numbers, std::string* warning, std::string* error) override;

    struct Entry {
        tinyobj::material_t values;
        std::set<std::string> keys;
        std::string where;  ///< file:line of its newmtl
    };
    [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
    Warnings& warnings_;
    std::vector<Entry> entries_;
};

/// The materials of `entries` with their textures, all decoded in parallel; messages go to `warnings`.
struct ObjMaterials {
    std::vector<Material> materials;  ///< texture handles are numbers of `textures` until they are added
    std::vector<TextureSlots> slots;
    std::vector<Texture> textures;
};
[[nodiscard]] ObjMaterials read_obj_materials(const MtlReader& reader, const std::filesystem::path& path,
                                              Warnings& warnings);

}  // namespace heliodon::import
