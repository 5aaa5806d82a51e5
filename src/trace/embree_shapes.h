#pragma once

#include "scene/geometry.h"
#include "trace/embree_api.h"

namespace heliodon::trace {

/// Makes a user geometry of Embree a sphere or a disk that rays meet exactly. `shape` must outlive it.
void answer_exactly(RTCGeometry geometry, const Shape& shape);

}  // namespace heliodon::trace
