#pragma once

#include "convert/flat_scene.h"
#include "passes/common/scene_inputs.h"

namespace heliodon::realtime {

/// Of the materials of what is visible, of all lights, and of the sky.
[[nodiscard]] passes::SceneFeatures scene_features(const convert::FlatScene& scene);

}  // namespace heliodon::realtime
