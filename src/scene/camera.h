#pragma once

#include <optional>
#include <string>

#include "core/math.h"

namespace heliodon {

/// A pinhole camera with a physical exposure. Orbit and free-fly controllers move position and target.
struct Camera {
    std::string name;
    glm::vec3 position{0, 1, 4};
    glm::vec3 target{0, 1, 0};
    glm::vec3 up{0, 1, 0};
    float vertical_fov_rad = 0.6981317f;  ///< 40°
    float near_m = 0.0f;                  ///< 0: chosen from the scene's bounds
    float far_m = 0.0f;                   ///< 0: infinite (reversed depth)
    float aperture_f = 2.8f;
    float shutter_s = 0.01f;
    float iso = 100.0f;
    std::optional<float> ev100_override;  ///< replaces aperture, shutter and ISO

    /// EV100 = log2(N²/t · 100/S).
    [[nodiscard]] float ev100() const;
    /// Rigid; the camera looks along −Z of its view space. `up` along the view direction falls back to another axis.
    [[nodiscard]] glm::mat4 world_to_view() const;
};

}  // namespace heliodon
