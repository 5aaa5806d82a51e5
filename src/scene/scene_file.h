#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/result.h"
#include "scene/scene.h"

namespace heliodon {

/// Reads the model at `path` and returns the node that holds it, added to `scene` below `parent`. The
/// scene room knows no model format: whoever loads a scene file passes the import room's function in.
using ModelReader =
    std::function<Result<NodeId>(Scene& scene, NodeId parent, const std::filesystem::path& path, Warnings& warnings)>;
/// Decodes picture files into textures of the scene, likewise from the import room. `TextureRequest`s of
/// one material that pack together (occlusion, roughness, metallic) are merged there.
struct MaterialTextures {
    std::filesystem::path base_color, roughness, metallic, occlusion, normal, bump, emission, opacity;
};
using MaterialTextureReader =
    std::function<Result<void>(Scene& scene, Material& material, const MaterialTextures& files, Warnings& warnings)>;
/// Reads a photometric file (IES, EULUMDAT); `lamp_set` counts from 1.
using LuminaireReader = std::function<Result<std::shared_ptr<const Luminaire>>(const std::filesystem::path& path, int lamp_set,
                                                                               Warnings& warnings)>;
/// Decodes an HDR picture (.hdr, .exr) for an image sky.
using SkyImageReader = std::function<Result<TextureId>(Scene& scene, const std::filesystem::path& path)>;

struct SceneFileReaders {
    ModelReader model;
    MaterialTextureReader material_textures;
    SkyImageReader sky_image;
    LuminaireReader luminaire = nullptr;
};

/// A `--set PATH=VALUE`: dotted path, list elements by name or index; VALUE is JSON, or a bare string.
struct Override {
    std::string path;
    std::string value;
    std::string option = {};  ///< what errors call it; empty: "--set PATH=VALUE"
};

/// Reads a `*.heliodon.json` scene file (docs/scene-format.md, docs/scene.schema.json). Unknown keys are
/// errors that name their JSON path. Errors are located: `file: $.nodes[3].light.flux_lm: expected a
/// number, found "bright"`; JSON syntax errors carry file:line:column.
[[nodiscard]] Result<Scene> read_scene_file(const std::filesystem::path& path, std::span<const Override> overrides,
                                            const SceneFileReaders& readers, Warnings& warnings);
/// The same from text; `base` resolves relative paths, `name` stands in messages.
[[nodiscard]] Result<Scene> parse_scene(std::string_view text, const std::string& name,
                                        const std::filesystem::path& base, std::span<const Override> overrides,
                                        const SceneFileReaders& readers, Warnings& warnings);

}  // namespace heliodon
