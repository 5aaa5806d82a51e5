#pragma once

#include "scene/camera.h"

namespace heliodon::editor {

/// Moves a camera as the mouse and keys ask; pure functions of the camera, so that they are tested without
/// a window. Angles in radians, motions in pixels of a window `height` pixels high.

/// Turns about the target: `delta` pixels right and down. The view never tips over the pole.
[[nodiscard]] Camera orbit(Camera camera, glm::vec2 delta, float height);
/// Shifts camera and target in the picture plane so that the target follows the pointer.
[[nodiscard]] Camera pan(Camera camera, glm::vec2 delta, float height);
/// Moves towards (positive) or away from the target by a tenth of the distance a step; never reaches it.
[[nodiscard]] Camera dolly(Camera camera, float steps);
/// Looks around from where it stands.
[[nodiscard]] Camera look(Camera camera, glm::vec2 delta, float height);
/// Flies: `motion` is metres to the right, up and forward.
[[nodiscard]] Camera fly(Camera camera, glm::vec3 motion_m);

}  // namespace heliodon::editor
