#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "import/texture_set.h"
#include "scene/scene_file.h"

namespace heliodon::import {

/// Which slot of a material uses which texture of a set.
using TextureSlots = std::vector<std::pair<TextureUse Material::*, int>>;

/// The single pictures of one material.
struct MaterialFiles {
    MaterialTextures files;
    SamplerState sampler;
    AlphaMode alpha_mode = AlphaMode::opaque;  ///< opaque: the base colour's alpha is dropped
    std::optional<float> alpha_cutoff;         ///< of the texture's alpha, where masked
};

/// Adds the textures that the pictures make: occlusion, roughness and metallic packed into one, opacity into
/// the base colour's alpha.
[[nodiscard]] TextureSlots add_material_files(const MaterialFiles& source, TextureSet& set);

}  // namespace heliodon::import
