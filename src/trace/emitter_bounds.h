#pragma once

#include "convert/flat_scene.h"
#include "shading/kernel_state.h"
#include "trace/light_tree.h"

namespace heliodon::trace {

/// Where an emitter of `lumen` is and how it shines. Not of directional lights and skies, which are nowhere.
[[nodiscard]] LightBounds emitter_bounds(const convert::FlatScene& flat, const shading::KernelEmitter& emitter,
                                         double lumen);

}  // namespace heliodon::trace
