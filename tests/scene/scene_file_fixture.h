#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_file.h"

namespace heliodon::tests {

inline Mesh one_triangle() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    return mesh;
}

/// Readers that open no file: a model is one triangle with a textured material and an animated child.
inline SceneFileReaders stub_readers(std::vector<std::string>* models_read = nullptr) {
    SceneFileReaders readers;
    readers.model = [models_read](Scene& scene, NodeId parent, const std::filesystem::path& path,
                                  Warnings&) -> Result<NodeId> {
        if (path.filename() == "missing.obj") return fail(path.string(), "expected a model, found no file");
        if (models_read) models_read->push_back(path.generic_string());
        const TextureId texture = scene.add_texture({.name = "texture of the model", .width = 1, .height = 1});
        Material material{.name = "of the model"};
        material.base_color_texture.texture = texture;
        const MaterialId material_id = scene.add_material(material);
        const GeometryId geometry = scene.add_geometry({"triangle", one_triangle(), std::nullopt, {}});
        const NodeId root = scene.add_node({.name = "model root"}, parent);
        const NodeId leaf = scene.add_node({.name = "model leaf", .parts = {{geometry, material_id}}}, root);
        AnimationChannel channel{
            AnimatedProperty::node_translation, leaf, Interpolation::linear, {0, 1}, {0, 0, 0, 2, 0, 0}};
        scene.add_animation({"model animation", {channel}});
        return root;
    };
    readers.material_textures = [](Scene& scene, Material& material, const MaterialTextures& files,
                                   Warnings&) -> Result<void> {
        if (files.base_color.filename() == "missing.png")
            return fail(files.base_color.string(), "expected a picture, found no file");
        material.base_color_texture.texture = scene.add_texture({.name = files.base_color.generic_string()});
        return {};
    };
    readers.sky_image = [](Scene& scene, const std::filesystem::path& path) -> Result<TextureId> {
        if (path.filename() == "missing.hdr") return fail(path.string(), "expected a picture, found no file");
        return scene.add_texture({.name = path.generic_string(), .format = TextureFormat::float32});
    };
    readers.luminaire = [](const std::filesystem::path& path, int lamp_set, Warnings&) -> Result<std::shared_ptr<const Luminaire>> {
        if (path.filename() == "missing.ies") return fail(path.string(), "expected a photometric file, found none");
        Luminaire luminaire{.name = path.generic_string()};  // 100 cd downwards, for each set more
        luminaire.web = {.polar_rad = {0, 1.5}, .azimuth_rad = {0}, .candela = {100.0 * lamp_set, 100.0 * lamp_set}};
        integrate(luminaire);
        return std::make_shared<const Luminaire>(std::move(luminaire));
    };
    return readers;
}

inline Result<Scene> parse(std::string_view text, std::vector<Override> overrides = {}) {
    Warnings warnings;
    return parse_scene(text, "test.json", "/base", overrides, stub_readers(), warnings);
}

/// The scene of `text`, or an empty one and a failed test.
inline Scene parsed(std::string_view text, std::vector<Override> overrides = {}) {
    Result<Scene> scene = parse(text, std::move(overrides));
    if (!scene) ADD_FAILURE() << scene.error().text();
    return scene ? *std::move(scene) : Scene{};
}

inline std::string error_of(std::string_view text, std::vector<Override> overrides = {}) {
    const Result<Scene> scene = parse(text, std::move(overrides));
    return scene ? "no error" : scene.error().text();
}

inline std::string file_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace heliodon::tests
