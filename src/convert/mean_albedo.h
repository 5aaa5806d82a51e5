#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "convert/flat_scene.h"

namespace heliodon::convert {

/// Mean of what visible opaque surfaces reflect of an even light, by area (each side's counts once): of textures the mean of
/// their texels. Instances whose mesh and size stay are not looked at again: moving one costs nothing by triangle.
class MeanAlbedo {
public:
    /// 0 where there is no such surface. Always of the same scene. `mesh_revisions`, by geometry, tell which meshes are others
    /// than they were. New instances take a few nanoseconds a triangle.
    [[nodiscard]] glm::vec3 of(const FlatScene& scene, std::span<const std::uint64_t> mesh_revisions);
    /// Meshes looked at so far.
    [[nodiscard]] std::uint64_t meshes_measured() const { return measured_; }

private:
    struct Part {
        std::uint32_t geometry = ~0u;
        std::uint64_t revision = 0;
        glm::mat3 metric{0};  // what lengths, so areas, follow from
        double area_m2 = 0;
        glm::vec3 vertex_color{1};
    };
    std::vector<Part> parts_;  // by instance
    std::uint64_t measured_ = 0;
};

}  // namespace heliodon::convert
