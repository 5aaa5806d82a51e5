#pragma once

#include <cstddef>
#include <functional>

namespace heliodon {

/// Calls `body(begin, end)` for consecutive pieces of [0, count), on all cores. A piece holds `grain`
/// items (the last may hold fewer) whatever the number of threads, so that work which keeps one result a
/// piece is deterministic. An exception of `body` leaves this function when all pieces have stopped.
/// `threads`: at most so many work at a time; 0 = all cores, 1 = the calling thread alone, in order.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body, int threads = 0);

}  // namespace heliodon
