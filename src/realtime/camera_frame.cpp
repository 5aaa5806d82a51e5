#include "realtime/camera_frame.h"

#include <algorithm>
#include <cmath>

#include "shading/environment.h"
#include "shading/tone.h"

namespace heliodon::realtime {

shading::FrameData camera_frame(const Camera& camera, const Bounds& scene, int width, int height, glm::vec2 jitter) {
    const glm::vec3 forward = glm::normalize(camera.target - camera.position);
    glm::vec3 side = glm::cross(forward, camera.up);
    // Looking along `up`: any other axis serves.
    if (glm::dot(side, side) < 1e-12f)
        side = glm::cross(forward, std::abs(forward.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1));
    const glm::vec3 right = glm::normalize(side);
    const glm::vec3 up = glm::cross(right, forward);
    const float tan_y = std::tan(0.5f * camera.vertical_fov_rad);
    const float tan_x = tan_y * static_cast<float>(width) / static_cast<float>(height);

    shading::FrameData frame{};
    frame.position = camera.position;
    frame.forward = forward;
    frame.exposure = shading::exposure_scale(camera.ev100());
    // Reversed float depth is as precise at any near distance; nearer surfaces are not seen.
    frame.near_m = camera.near_m > 0 ? camera.near_m : std::max(scene.diagonal(), 1e-3f) * 1e-5f;
    frame.ray_corner = forward - right * tan_x + up * tan_y;
    frame.ray_dx = right * (2.0f * tan_x / static_cast<float>(width));
    frame.ray_dy = up * (-2.0f * tan_y / static_cast<float>(height));
    frame.width = static_cast<std::uint32_t>(width);
    frame.height = static_cast<std::uint32_t>(height);
    frame.jitter = jitter;

    const auto row = [&](glm::vec3 axis) { return glm::vec4(axis, -glm::dot(axis, camera.position)); };
    const glm::vec4 w = row(forward);
    const float n = frame.near_m;
    const float f = camera.far_m;
    // z/w is 1 at the near plane and 0 at the far one, or at infinity.
    const glm::vec4 z = f > n ? -n / (f - n) * w + glm::vec4(0, 0, 0, n * f / (f - n)) : glm::vec4(0, 0, 0, n);
    frame.world_to_clip = glm::transpose(
        glm::mat4(row(right / tan_x) - 2.0f * jitter.x / static_cast<float>(width) * w,
                  row(up / tan_y) + 2.0f * jitter.y / static_cast<float>(height) * w, z, w));
    return frame;
}

glm::vec2 sample_position(std::uint32_t index, std::uint32_t count, std::uint32_t seed) {
    glm::vec2 point;
    if (count > 0) {
        // The radical inverse is centred in its cells too, or the mean would be half a cell off; turned by a half,
        // or √count points would lie on each diagonal, where edges through pixels' corners give them to one side.
        point = glm::fract(shading::hammersley(index, count) + glm::vec2(0.0f, 0.5f + 0.5f / static_cast<float>(count)));
    } else {
        // 1/φ₂ and 1/φ₂² of the plastic number; doubles, because the index grows without end.
        point = {static_cast<float>(std::fmod(0.5 + 0.7548776662466927 * index, 1.0)),
                 static_cast<float>(std::fmod(0.5 + 0.5698402909980532 * index, 1.0))};
    }
    if (seed == 0) return point;
    const glm::vec2 shift(static_cast<float>(std::fmod(0.7548776662466927 * seed, 1.0)),
                          static_cast<float>(std::fmod(0.5698402909980532 * seed, 1.0)));
    return glm::fract(point + shift);
}

}  // namespace heliodon::realtime
