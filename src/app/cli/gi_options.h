#pragma once

#include <string>

#include "app/cli/scene_argument.h"
#include "scene/scene.h"

namespace heliodon::cli {

/// `--gi` and `--voxels`, which win over the scene's `render` block.
struct GiOptions {
    std::string gi;  ///< none, vct; empty: as the scene says
    int voxels = 0;  ///< an edge of the volume; 0: as the scene says

    [[nodiscard]] bool given() const { return !gi.empty() || voxels != 0; }
};
void add_gi_options(CLI::App& command, GiOptions& options);

/// Edits the scene's settings by the options. A kind of global illumination that this version lacks becomes "none",
/// which is said on standard error.
void apply_gi_options(const GiOptions& options, const SceneArgument& argument, Scene& scene);

/// Says so where the options have no effect on a scene that stays as it is.
void warn_without_effect(const GiOptions& options, const Scene& scene);

}  // namespace heliodon::cli
