#pragma once

#include <functional>

namespace heliodon {

/// Called now and then with the fraction done (0..1); returning false asks the work to stop early.
using Progress = std::function<bool(double fraction)>;

}  // namespace heliodon
