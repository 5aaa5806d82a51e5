#pragma once

#include <vector>

#include "scene/scene.h"

namespace heliodon {

/// `sky` with its sun where it stands at `time`. A sky without a place stays as it is; a CIE sky's sun does not set.
[[nodiscard]] Sky sky_at(Sky sky, const CivilTime& time);

/// `count` moments from `first` to `last`, evenly, by the clock of `first`; of one alone, `first`.
[[nodiscard]] std::vector<CivilTime> moments_between(const CivilTime& first, const CivilTime& last, std::size_t count);
/// From `first` on in steps of `step_s` > 0, up to and with `last`.
[[nodiscard]] std::vector<CivilTime> moments_by_step(const CivilTime& first, const CivilTime& last, double step_s);

}  // namespace heliodon
