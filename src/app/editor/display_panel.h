#pragma once

#include "scene/scene.h"

namespace heliodon::editor {

/// Controls of how light is shown: exposure meter, tone curve, white balance.
void display_panel(Scene& scene);

}  // namespace heliodon::editor
