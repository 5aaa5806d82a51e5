#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "import/gltf_document.h"

namespace heliodon::import::gltf {
namespace {

constexpr std::array known_extensions = {
    "KHR_lights_punctual",    "KHR_materials_emissive_strength", "KHR_materials_ior",      "KHR_materials_transmission",
    "KHR_materials_specular", "KHR_materials_clearcoat",         "KHR_materials_unlit",    "KHR_mesh_quantization",
    "KHR_texture_transform",  "KHR_draco_mesh_compression",      "EXT_meshopt_compression", "KHR_materials_anisotropy",
    "KHR_materials_sheen",    "KHR_materials_iridescence",       "KHR_materials_volume"};

bool is_known(const std::string& name) {
    return std::find(known_extensions.begin(), known_extensions.end(), name) != known_extensions.end();
}

void check_type(const Document& document, const Json& object, const char* key, bool (Json::*is)() const noexcept,
                const char* expected, std::string_view at) {
    const auto member = object.find(key);
    if (member != object.end() && !((*member).*is)())
        document.refuse(fmt::format("{}.{}", at, key),
                        fmt::format("expected {}, found {}", expected, member->type_name()));
}

void check_extensions(const Document& document, Warnings& warnings) {
    const Json& json = document.json();
    for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
        if (!json.contains(list)) continue;
        if (!json[list].is_array()) document.refuse(fmt::format("$.{}", list), "expected a list of names");
        std::string unknown;
        for (const Json& name : json[list]) {
            if (!name.is_string()) document.refuse(fmt::format("$.{}", list), "expected a list of names");
            if (is_known(name)) continue;
            if (std::string_view(list) == "extensionsRequired")
                document.refuse(
                    "$.extensionsRequired",
                    fmt::format("the file needs the extension {}, which is not read here", name.get<std::string>()));
            unknown += (unknown.empty() ? "" : ", ") + name.get<std::string>();
        }
        if (!unknown.empty())
            warnings.push_back({document.where("$.extensionsUsed"), "ignores what is not read here: " + unknown});
    }
}

void check_arrays(const Document& document) {
    for (const char* name : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials",
                             "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
        const auto array = document.json().find(name);
        if (array == document.json().end()) continue;
        if (!array->is_array()) document.refuse(fmt::format("$.{}", name), "expected a list");
        for (std::size_t i = 0; i < array->size(); ++i) {
            const std::string at = fmt::format("$.{}[{}]", name, i);
            if (!(*array)[i].is_object()) document.refuse(at, "expected an object");
            check_type(document, (*array)[i], "name", &Json::is_string, "a string", at);
            check_type(document, (*array)[i], "uri", &Json::is_string, "a string", at);
            check_type(document, (*array)[i], "extensions", &Json::is_object, "an object", at);
        }
    }
}

void check_accessors(const Document& document) {
    for (std::size_t i = 0; i < document.count("accessors"); ++i) {
        const Json& accessor = document.json()["accessors"][i];
        const std::string at = fmt::format("$.accessors[{}]", i);
        check_type(document, accessor, "type", &Json::is_string, "a string", at);
        check_type(document, accessor, "normalized", &Json::is_boolean, "true or false", at);
        check_type(document, accessor, "sparse", &Json::is_object, "an object", at);
        if (!accessor.contains("sparse")) continue;
        for (const char* part : {"indices", "values"})
            if (!accessor["sparse"].contains(part) || !accessor["sparse"][part].is_object())
                document.refuse(fmt::format("{}.sparse.{}", at, part), "expected an object");
    }
    for (std::size_t i = 0; i < document.count("bufferViews"); ++i) {
        const std::string at = fmt::format("$.bufferViews[{}]", i);
        const Json& view = document.json()["bufferViews"][i];
        if (!index_member(document, view, "buffer", "buffers", at)) document.refuse(at, "expected a buffer");
        if (const Json* meshopt = extension(view, "EXT_meshopt_compression")) {
            const std::string inside = at + ".extensions.EXT_meshopt_compression";
            if (!index_member(document, *meshopt, "buffer", "buffers", inside))
                document.refuse(inside, "expected a buffer");
            check_type(document, *meshopt, "mode", &Json::is_string, "a string", inside);
            check_type(document, *meshopt, "filter", &Json::is_string, "a string", inside);
        }
    }
}

void check_primitive(const Document& document, const Json& primitive, const std::string& at) {
    if (!primitive.is_object()) document.refuse(at, "expected an object");
    check_type(document, primitive, "attributes", &Json::is_object, "an object", at);
    check_type(document, primitive, "extensions", &Json::is_object, "an object", at);
    if (!primitive.contains("attributes")) document.refuse(at, "expected attributes");
    for (const auto& [name, accessor] : primitive["attributes"].items())
        (void)index_member(document, primitive["attributes"], name.c_str(), "accessors", at + ".attributes");
    (void)index_member(document, primitive, "indices", "accessors", at);
    (void)index_member(document, primitive, "material", "materials", at);
    if (const std::size_t mode = unsigned_member(document, primitive, "mode", 4, at); mode > 6)
        document.refuse(at + ".mode", fmt::format("expected 0 to 6, found {}", mode));
    const Json* draco = extension(primitive, "KHR_draco_mesh_compression");
    if (!draco) return;
    const std::string inside = at + ".extensions.KHR_draco_mesh_compression";
    if (!index_member(document, *draco, "bufferView", "bufferViews", inside))
        document.refuse(inside, "expected a bufferView");
    if (!draco->contains("attributes") || !(*draco)["attributes"].is_object())
        document.refuse(inside, "expected attributes");
    for (const auto& [name, id] : (*draco)["attributes"].items())
        (void)unsigned_member(document, (*draco)["attributes"], name.c_str(), {}, inside + ".attributes");
}

void check_meshes(const Document& document) {
    for (std::size_t i = 0; i < document.count("meshes"); ++i) {
        const Json& mesh = document.json()["meshes"][i];
        const std::string at = fmt::format("$.meshes[{}]", i);
        if (!mesh.contains("primitives") || !mesh["primitives"].is_array())
            document.refuse(at, "expected a list of primitives");
        for (std::size_t p = 0; p < mesh["primitives"].size(); ++p)
            check_primitive(document, mesh["primitives"][p], fmt::format("{}.primitives[{}]", at, p));
    }
}

void check_numbers(const Document& document, const Json& object, const char* key, std::size_t length,
                   std::string_view at) {
    if (!object.contains(key)) return;
    const Json& list = object[key];
    const bool good = list.is_array() && list.size() == length &&
                      std::all_of(list.begin(), list.end(), [](const Json& n) { return n.is_number(); });
    if (!good) document.refuse(fmt::format("{}.{}", at, key), fmt::format("expected {} numbers", length));
}

/// Nodes form a forest: every node has one parent at most, and none is its own ancestor.
void check_nodes(const Document& document) {
    const std::size_t count = document.count("nodes");
    constexpr std::size_t none = std::size_t(-1);
    std::vector<std::size_t> parent(count, none);
    for (std::size_t i = 0; i < count; ++i) {
        const Json& node = document.json()["nodes"][i];
        const std::string at = fmt::format("$.nodes[{}]", i);
        (void)index_member(document, node, "mesh", "meshes", at);
        (void)index_member(document, node, "camera", "cameras", at);
        (void)index_member(document, node, "skin", "skins", at);
        check_numbers(document, node, "matrix", 16, at);
        check_numbers(document, node, "translation", 3, at);
        check_numbers(document, node, "rotation", 4, at);
        check_numbers(document, node, "scale", 3, at);
        if (!node.contains("children")) continue;
        if (!node["children"].is_array()) document.refuse(at + ".children", "expected a list of node indices");
        for (std::size_t c = 0; c < node["children"].size(); ++c) {
            const Json& child = node["children"][c];
            const std::string child_at = fmt::format("{}.children[{}]", at, c);
            if (!child.is_number_unsigned() || child.get<std::size_t>() >= count)
                document.refuse(child_at,
                                fmt::format("expected a node from 0 to {}, found {}", count - 1, child.dump()));
            std::size_t& parent_of_child = parent[child.get<std::size_t>()];
            if (parent_of_child != none)
                document.refuse(child_at, fmt::format("node {} has two parents, {} and {}", child.get<std::size_t>(),
                                                      parent_of_child, i));
            parent_of_child = i;
        }
    }
    // Climbing from every node; nodes known to reach a root are not climbed twice.
    std::vector<char> reaches_root(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<std::size_t> path;
        for (std::size_t at = i; at != none && !reaches_root[at]; at = parent[at]) {
            path.push_back(at);
            if (path.size() > count)
                document.refuse(fmt::format("$.nodes[{}]", at), "is its own ancestor: the nodes form a cycle");
        }
        for (const std::size_t node : path) reaches_root[node] = 1;
    }
}

void check_scenes(const Document& document) {
    (void)index_member(document, document.json(), "scene", "scenes", "$");
    for (std::size_t i = 0; i < document.count("scenes"); ++i) {
        const Json& scene = document.json()["scenes"][i];
        if (!scene.contains("nodes")) continue;
        const std::string at = fmt::format("$.scenes[{}].nodes", i);
        if (!scene["nodes"].is_array()) document.refuse(at, "expected a list of node indices");
        std::set<std::size_t> seen;
        for (const Json& node : scene["nodes"]) {
            if (!node.is_number_unsigned() || node.get<std::size_t>() >= document.count("nodes"))
                document.refuse(at, fmt::format("node {} does not exist", node.dump()));
            if (!seen.insert(node.get<std::size_t>()).second)
                document.refuse(at, fmt::format("names node {} twice", node.dump()));
        }
    }
}

/// Texture references anywhere inside a material, its extensions included.
void check_texture_references(const Document& document, const Json& object, const std::string& at) {
    for (const auto& [key, value] : object.items()) {
        if (!value.is_object() || key == "extras") continue;
        const std::string inside = at + "." + key;
        if (key.ends_with("Texture")) {
            if (!index_member(document, value, "index", "textures", inside))
                document.refuse(inside, "expected an index");
            (void)unsigned_member(document, value, "texCoord", 0, inside);
        }
        check_texture_references(document, value, inside);
    }
}

void check_materials(const Document& document) {
    for (std::size_t i = 0; i < document.count("materials"); ++i)
        check_texture_references(document, document.json()["materials"][i], fmt::format("$.materials[{}]", i));
    for (std::size_t i = 0; i < document.count("textures"); ++i) {
        const std::string at = fmt::format("$.textures[{}]", i);
        (void)index_member(document, document.json()["textures"][i], "source", "images", at);
        (void)index_member(document, document.json()["textures"][i], "sampler", "samplers", at);
    }
    for (std::size_t i = 0; i < document.count("images"); ++i) {
        const std::string at = fmt::format("$.images[{}]", i);
        const Json& image = document.json()["images"][i];
        if (!index_member(document, image, "bufferView", "bufferViews", at) && !image.contains("uri"))
            document.refuse(at, "expected a uri or a bufferView");
    }
}

void check_animations(const Document& document) {
    for (std::size_t i = 0; i < document.count("animations"); ++i) {
        const Json& animation = document.json()["animations"][i];
        const std::string at = fmt::format("$.animations[{}]", i);
        for (const char* list : {"channels", "samplers"})
            if (!animation.contains(list) || !animation[list].is_array())
                document.refuse(fmt::format("{}.{}", at, list), "expected a list");
        for (std::size_t s = 0; s < animation["samplers"].size(); ++s)
            for (const char* key : {"input", "output"}) {
                const std::string inside = fmt::format("{}.samplers[{}]", at, s);
                if (!index_member(document, animation["samplers"][s], key, "accessors", inside))
                    document.refuse(inside, fmt::format("expected an {}", key));
            }
        for (std::size_t c = 0; c < animation["channels"].size(); ++c) {
            const Json& channel = animation["channels"][c];
            const std::string inside = fmt::format("{}.channels[{}]", at, c);
            if (unsigned_member(document, channel, "sampler", {}, inside) >= animation["samplers"].size())
                document.refuse(inside + ".sampler", "does not exist");
            if (!channel.contains("target") || !channel["target"].is_object())
                document.refuse(inside + ".target", "expected an object");
            (void)index_member(document, channel["target"], "node", "nodes", inside + ".target");
        }
    }
}

}  // namespace

std::size_t unsigned_member(const Document& document, const Json& object, const char* key,
                            std::optional<std::size_t> fallback, std::string_view json_path) {
    if (!object.is_object()) document.refuse(json_path, "expected an object");
    const auto member = object.find(key);
    if (member == object.end()) {
        if (!fallback) document.refuse(json_path, fmt::format("expected \"{}\", found none", key));
        return *fallback;
    }
    if (!member->is_number_unsigned())
        document.refuse(fmt::format("{}.{}", json_path, key),
                        fmt::format("expected a whole number from 0 on, found {}", member->dump()));
    return member->get<std::size_t>();
}

std::optional<std::size_t> index_member(const Document& document, const Json& object, const char* key,
                                        const char* array, std::string_view json_path) {
    if (object.is_object() && !object.contains(key)) return std::nullopt;
    const std::size_t index = unsigned_member(document, object, key, {}, json_path);
    if (index >= document.count(array))
        document.refuse(fmt::format("{}.{}", json_path, key), fmt::format("index {} is out of range: {} has {} entries",
                                                                          index, array, document.count(array)));
    return index;
}

const Json* extension(const Json& object, const char* name) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return nullptr;
    const auto found = extensions->find(name);
    return found == extensions->end() || !found->is_object() ? nullptr : &*found;
}

void validate(const Document& document, Warnings& warnings) {
    const Json& json = document.json();
    const Json* asset = json.contains("asset") ? &json["asset"] : nullptr;
    if (!asset || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
        document.refuse("$.asset.version", "expected a glTF version");
    if (const std::string version = (*asset)["version"]; !version.starts_with("2."))
        document.refuse("$.asset.version", fmt::format("expected glTF 2, found \"{}\"", version));
    check_extensions(document, warnings);
    check_arrays(document);
    check_accessors(document);
    check_meshes(document);
    check_nodes(document);
    check_scenes(document);
    check_materials(document);
    check_animations(document);
}

}  // namespace heliodon::import::gltf
