#include "import/obj_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <istream>

#include "core/image_io.h"
#include "import/import_failure.h"
#include "import/material_range.h"
#include "import/obj_text.h"

namespace heliodon::import {
namespace {

/// Keys whose values are numbers, which tinyobjloader would read as 0 where they are not.
constexpr std::array numeric_keys = {"Ka", "Kd", "Ks", "Ke", "Tf", "Kt",  "Ns",    "Ni",     "d",
                                     "Tr", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor", "illum"};

std::string forward_slashes(std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    return name;
}

/// Perceptual roughness of a Phong exponent: Beckmann's α² = 2/(n + 2) (Walter et al. 2007, section 5.2),
/// α being roughness².
float roughness_of_exponent(float exponent) {
    return std::pow(2.0f / (std::max(exponent, 0.0f) + 2.0f), 0.25f);
}

/// -s and -o of a map statement, in MTL's coordinates (v up), turned into glTF's (v down).
void set_transform(const tinyobj::texture_option_t& options, TextureUse& use) {
    const glm::vec2 scale(options.scale[0], options.scale[1]),
        offset(options.origin_offset[0], options.origin_offset[1]);
    use.uv_matrix = glm::mat2(scale.x, 0, 0, scale.y);
    use.uv_offset = {offset.x, 1 - scale.y - offset.y};
}

struct Notes {
    bool emission = false, phong = false, specular = false, sheen = false, range = false;
};

Material basic_material(const MtlReader::Entry& entry, Notes& notes) {
    const tinyobj::material_t& source = entry.values;
    const auto has = [&](const char* key) { return entry.keys.contains(key); };
    Material material;
    material.name = source.name;
    material.base_color = {source.diffuse[0], source.diffuse[1], source.diffuse[2]};
    if (!has("Kd")) material.base_color = has("map_Kd") ? glm::vec3(1) : glm::vec3(0.8f);
    material.emission_nits = {source.emission[0], source.emission[1], source.emission[2]};
    if (has("map_Ke") && !has("Ke")) material.emission_nits = glm::vec3(1);
    notes.emission |= material.emission_nits != glm::vec3(0);
    material.opacity = std::clamp(source.dissolve, 0.0f, 1.0f);
    if (material.opacity < 1) material.alpha_mode = AlphaMode::blend;
    if (has("Ni") && source.ior >= 1) material.ior = source.ior;
    if (has("Pr") || has("Pm") || has("map_Pr") || has("map_Pm")) {
        material.roughness = has("Pr") ? source.roughness : has("map_Pr") ? 1.0f : 0.5f;
        material.metallic = has("Pm") ? source.metallic : has("map_Pm") ? 1.0f : 0.0f;
        material.clearcoat = source.clearcoat_thickness;
        material.clearcoat_roughness = source.clearcoat_roughness;
        notes.sheen |= has("Ps") || has("aniso");
    } else {
        const bool shiny =
            has("Ks") && source.specular[0] + source.specular[1] + source.specular[2] > 0 && source.illum != 1;
        material.specular = shiny ? 1.0f : 0.0f;
        material.roughness = shiny && has("Ns") ? roughness_of_exponent(source.shininess) : 1.0f;
        notes.phong |= shiny;
        notes.specular |= has("map_Ks");
    }
    notes.range |= bring_into_range(material, entry.where);
    return material;
}

}  // namespace

bool MtlReader::operator()(const std::string& file, std::vector<tinyobj::material_t>* materials,
                           std::map<std::string, int>* numbers, std::string*, std::string*) {
    const std::filesystem::path path = folder_ / forward_slashes(file);
    const Result<std::string> text = read_file(path);
    if (!text) {
        warnings_.push_back({path.string(), "cannot be read; its materials are the default one"});
        return false;
    }
    const std::size_t first = entries_.size();
    LineStream lines(*text, [&](std::string_view line, int number) {
        const std::vector<std::string_view> words = words_of(line);
        if (words.empty() || words[0].starts_with('#')) return;
        const std::string where = fmt::format("{}:{}", path.string(), number);
        if (words[0] == "newmtl") {
            if (words.size() < 2) refuse(where, "expected a name after newmtl");
            entries_.push_back({{}, {}, where});
        } else if (entries_.size() > first) {
            entries_.back().keys.insert(std::string(words[0]));
        }
        if (std::find(numeric_keys.begin(), numeric_keys.end(), words[0]) == numeric_keys.end()) return;
        if (words.size() < 2) refuse(where, fmt::format("expected a number after {}", words[0]));
        if (words[1] == "spectral" || words[1] == "xyz")
            refuse(where, fmt::format("{} {} is not read here", words[0], words[1]));
        for (std::size_t i = 1; i < words.size() && !words[i].starts_with('#'); ++i)
            if (!finite_number(words[i]) && words[i] != "-halo")
                refuse(where, fmt::format("expected a finite number, found \"{}\"", words[i]));
    });
    std::istream stream(&lines);
    stream.exceptions(std::ios::badbit);  // what a line is refused for passes through the stream
    const std::size_t before = materials->size();
    std::string warning, error;
    tinyobj::LoadMtl(numbers, materials, &stream, &warning, &error);
    // tinyobjloader adds one material even for a file without any.
    for (std::size_t i = 0; i + first < entries_.size() && before + i < materials->size(); ++i)
        entries_[first + i].values = (*materials)[before + i];
    return true;
}

ObjMaterials read_obj_materials(const MtlReader& reader, const std::filesystem::path& path, Warnings& warnings) {
    ObjMaterials result;
    TextureSet set;
    Notes notes;
    for (const MtlReader::Entry& entry : reader.entries()) {
        const tinyobj::material_t& source = entry.values;
        Material material = basic_material(entry, notes);
        const auto file = [&](const std::string& name) {
            return name.empty() ? std::filesystem::path() : reader.folder() / forward_slashes(name);
        };
        // Whether alpha means anything is seen once the picture is decoded.
        MaterialFiles files{.files = {}, .sampler = {}, .alpha_mode = AlphaMode::blend, .alpha_cutoff = {}};
        files.files = {.base_color = file(source.diffuse_texname),
                       .roughness = file(source.roughness_texname),
                       .metallic = file(source.metallic_texname),
                       .occlusion = {},
                       .normal = file(source.normal_texname),
                       .bump = file(source.bump_texname),
                       .emission = file(source.emissive_texname),
                       .opacity = file(source.alpha_texname)};
        if (source.diffuse_texopt.clamp) files.sampler.wrap_u = files.sampler.wrap_v = Wrap::clamp_to_edge;
        if (!source.bump_texname.empty()) material.bump_scale_m *= source.bump_texopt.bump_multiplier;
        auto slots = add_material_files(files, set);
        set_transform(source.diffuse_texopt, material.base_color_texture);
        set_transform(source.roughness_texopt, material.orm_texture);
        set_transform(source.normal_texopt, material.normal_texture);
        set_transform(source.bump_texopt, material.bump_texture);
        set_transform(source.emissive_texopt, material.emission_texture);
        result.materials.push_back(std::move(material));
        result.slots.push_back(std::move(slots));
    }
    result.textures = set.build();
    for (std::size_t i = 0; i < result.materials.size(); ++i)
        for (const auto& [slot, number] : result.slots[i]) {
            Material& material = result.materials[i];
            if (slot != &Material::base_color_texture || material.alpha_mode != AlphaMode::opaque) continue;
            Texture& texture = result.textures[std::size_t(number)];
            material.alpha_mode = alpha_mode_of(texture);
            if (material.alpha_mode == AlphaMode::mask) build_mip_chain(texture, material.alpha_cutoff);
        }
    const auto say = [&](bool happened, const char* text) {
        if (happened) warnings.push_back({path.string(), text});
    };
    say(notes.emission, "MTL gives Ke no unit; it is taken as cd/m²");
    say(notes.phong, "takes Phong highlights (Ks, Ns) as a dielectric coat of the same width");
    say(notes.specular, "ignores map_Ks");
    say(notes.range, "brings material factors outside their range into it");
    say(notes.sheen, "ignores sheen and anisotropy");
    return result;
}

}  // namespace heliodon::import
