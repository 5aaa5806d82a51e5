#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/json_document.h"
#include "scene/scene_file.h"

namespace heliodon::scene_file {

/// Where an override ended up, so that what the reader then refuses is told of the override, not of the file.
struct AppliedOverride {
    std::string label;       ///< "--set PATH=VALUE"
    std::string json_path;   ///< of the value it set
    std::string first_made;  ///< of the topmost value it made on the way; json_path where it made none
};

/// Sets the values in `document`. A key that is missing is made; reading the document refuses it when unknown.
/// One of several alternatives (a light's flux and intensity) replaces the others.
[[nodiscard]] Result<std::vector<AppliedOverride>> apply_overrides(Json& document, std::span<const Override> overrides);

}  // namespace heliodon::scene_file
