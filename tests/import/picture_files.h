#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace heliodon::tests {

/// A PNG of interleaved 8-bit texels.
[[nodiscard]] std::string png(int width, int height, int channels, const std::vector<std::uint8_t>& texels);

}  // namespace heliodon::tests
