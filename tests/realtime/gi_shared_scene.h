// The shared Cornell box under a point light, with the path tracer's picture of it.
#pragma once

#include "gi_test.h"
#include "import/import.h"
#include "shared_data.h"

namespace heliodon::tests {

struct ReferencedScene {
    Scene scene;
    Camera camera;
    Picture reference;  ///< 128×128
};

/// In 64³ voxels; nothing without the shared data.
inline std::optional<ReferencedScene> cornell_box_under_a_point_light() {
    const auto path = shared_path("scenes/cornell-point.heliodon.json");
    if (!path) return std::nullopt;
    Warnings warnings;
    auto scene = load_scene(*path, {}, warnings);
    auto reference = read_picture(std::filesystem::path(HELIODON_SOURCE_DIR) / "tests/references/gi-cornell-point.exr");
    if (!scene || !reference) throw std::runtime_error("cornell-point: no scene or no reference");
    ReferencedScene result{std::move(*scene), {}, std::move(*reference)};
    use_cone_tracing(result.scene, 64);
    result.scene.cameras().each([&](CameraId, const Camera& first) { result.camera = first; });
    return result;
}

}  // namespace heliodon::tests
