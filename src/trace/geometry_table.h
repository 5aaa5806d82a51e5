#pragma once

#include <cstdint>
#include <vector>

#include "convert/flat_scene.h"
#include "shading/kernel_state.h"

namespace heliodon::trace {

/// Where the kernel finds a geometry's vertex data: the scene's own arrays.
struct GeometryArrays {
    const std::uint32_t* indices = nullptr;
    const glm::vec3* positions = nullptr;
    const glm::vec3* normals = nullptr;
    const glm::vec4* tangents = nullptr;
    const glm::vec4* colors = nullptr;
    const glm::vec2* texcoords[2] = {nullptr, nullptr};
    shading::KernelGeometry kernel{};
};
using GeometryTable = std::vector<GeometryArrays>;

[[nodiscard]] GeometryTable build_geometry_table(const convert::FlatScene& flat);

}  // namespace heliodon::trace
