#pragma once

#include <filesystem>

#include "core/result.h"
#include "scene/scene.h"

namespace heliodon::import {

// One a format; each throws ImportFailure and then leaves the scene as it was.
[[nodiscard]] NodeId import_gltf(Scene& scene, NodeId parent, const std::filesystem::path& path, Warnings& warnings);
/// A photometric file: a node with its light.
[[nodiscard]] NodeId import_luminaire(Scene& scene, NodeId parent, const std::filesystem::path& path, Warnings& warnings);
[[nodiscard]] NodeId import_obj(Scene& scene, NodeId parent, const std::filesystem::path& path, Warnings& warnings);

}  // namespace heliodon::import
