#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace heliodon {

/// A moment, and the offset from UTC of the clock that shows it.
struct CivilTime {
    double unix_s = 0;   ///< seconds since 1970-01-01T00:00:00Z, days of 86400 s each
    int offset_min = 0;  ///< of the clock, minutes east of UTC
};

inline constexpr int first_year = 1900, last_year = 2100;  ///< that the theory of the Earth's motion covers

/// ISO 8601:2004, the extended calendar format: 2026-03-21T09:00[:00[.5]] and then Z or ±HH[:MM]. Years first_year to
/// last_year. A leap second (…:60) is refused: the rotation of the Earth knows none. `where` locates the error.
[[nodiscard]] Result<CivilTime> parse_civil_time(std::string_view text, const std::string& where = {});
/// The same format, rounded to whole seconds.
[[nodiscard]] std::string to_iso8601(const CivilTime& time);
/// When the clock's day of `time` began.
[[nodiscard]] CivilTime start_of_day(const CivilTime& time);

}  // namespace heliodon
