#pragma once

#include <vector>

#include "trace/emitter_table.h"

namespace heliodon::trace {

/// Where light subpaths start: each emitter with its share of them, then the constant sky where there is one. The
/// shares are those of EmitterTable's kind, half by luminous flux and half evenly.
struct EmissionTable {
    std::vector<float> cumulative;
    glm::vec4 scene_sphere{0, 0, 0, 1};  ///< centre and radius, m: light from afar sets out on a disc about it
};

[[nodiscard]] EmissionTable build_emission(const convert::FlatScene& flat, const EmitterTable& emitters,
                                           bool environment);

}  // namespace heliodon::trace
