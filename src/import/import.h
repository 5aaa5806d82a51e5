#pragma once

#include <filesystem>
#include <memory>

#include "core/result.h"
#include "scene/scene.h"
#include "scene/scene_file.h"

namespace heliodon {

/// Reads a model by its ending (.obj, .gltf, .glb; a luminaire alone: .ies, .ldt) into `scene` below `parent`; returns its root node.
/// What was approximated or ignored is told in `warnings`, one message each.
[[nodiscard]] Result<NodeId> import_model(Scene& scene, NodeId parent, const std::filesystem::path& path,
                                          Warnings& warnings);

/// The reader functions that read_scene_file wants.
[[nodiscard]] SceneFileReaders scene_file_readers();

/// Any SCENE of the command line: a scene file, or a model made presentable with a default camera, sky
/// and exposure.
[[nodiscard]] Result<Scene> load_scene(const std::filesystem::path& path, std::span<const Override> overrides,
                                       Warnings& warnings);

/// Decodes one picture file into a texture with its mip chain (sRGB-correct filtering).
[[nodiscard]] Result<Texture> load_texture(const std::filesystem::path& path, TextureFormat format);
/// Reads a photometric file, IES LM-63 or EULUMDAT by its content; of an EULUMDAT file's sets of lamps the one of this
/// number, from 1. What is doubtful or contradicts itself is told in `warnings`.
[[nodiscard]] Result<std::shared_ptr<const Luminaire>> load_luminaire(const std::filesystem::path& path, int lamp_set,
                                                                      Warnings& warnings);
/// Fills levels 1… from level 0: box filter in linear light.
void build_mip_chain(Texture& texture);
/// Makes missing normals (angle-weighted; creases of a faceted mesh stay) and tangents (per UV gradient).
void complete_mesh(Mesh& mesh);

}  // namespace heliodon
