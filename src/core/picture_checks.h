#pragma once

#include "core/image.h"
#include "core/result.h"

namespace heliodon {

/// Pictures of one size, not empty, finite in every colour value, and a finite exposure.
[[nodiscard]] Result<void> check_comparable(const Image& reference, const Image& test, float ev100);

}  // namespace heliodon
