#pragma once

#include <cstdint>
#include <span>

namespace heliodon::shading {

/// Every table of the shading room in one array, computed once by deterministic quadrature (about a
/// fifth of a second at the first call; safe from any thread). The real-time engine uploads it as it is;
/// ggx_albedo.h says what stands where.
[[nodiscard]] std::span<const float> shading_tables();

/// What GLSL includers provide from that upload: entry `index`.
[[nodiscard]] inline float shading_table(std::uint32_t index) {
    static const float* const values = shading_tables().data();
    return values[index];
}

}  // namespace heliodon::shading
