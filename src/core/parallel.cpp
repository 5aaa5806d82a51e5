#include "core/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace heliodon {

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body, int threads) {
    if (count == 0) return;
    grain = std::max<std::size_t>(grain, 1);
    const std::size_t pieces = (count - 1) / grain + 1;
    const auto run_piece = [&](std::size_t piece) {
        const std::size_t begin = piece * grain;
        body(begin, begin + std::min(grain, count - begin));
    };
    if (threads == 1 || pieces == 1) {
        for (std::size_t piece = 0; piece < pieces; ++piece) run_piece(piece);
    } else if (threads <= 0) {
        tbb::parallel_for(std::size_t{0}, pieces, run_piece);
    } else {
        // More than there are cores would only make TBB complain on standard error.
        tbb::task_arena arena(std::min(threads, tbb::info::default_concurrency()));
        arena.execute([&] { tbb::parallel_for(std::size_t{0}, pieces, run_piece); });
    }
}

}  // namespace heliodon
