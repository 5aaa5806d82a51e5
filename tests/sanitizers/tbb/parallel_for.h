#pragma once

// In place of TBB under ThreadSanitizer, which does not see the forks and joins of a library that is not compiled
// with it and takes every handing over of work for a race. Standard threads it sees. HELIODON_SANITIZE=thread puts
// this folder before the system's (cmake/HeliodonRooms.cmake); the folder has what the program uses of TBB.

#include <tbb/blocked_range2d.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {

struct simple_partitioner {};

/// Calls `work(0)` … `work(count - 1)` on four threads; the first exception leaves it.
template <class Work>
void on_threads(std::size_t count, Work&& work) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failing;
    const auto take_work = [&] {
        try {
            // Relaxed, so that taking work orders nothing that the program itself does not order.
            for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) work(i);
        } catch (...) {
            const std::lock_guard lock(failing);
            if (!failure) failure = std::current_exception();
        }
    };
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) threads.emplace_back(take_work);
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

template <class Index, class Work>
void parallel_for(Index begin, Index end, const Work& work) {
    on_threads(static_cast<std::size_t>(end - begin), [&](std::size_t i) { work(static_cast<Index>(begin + i)); });
}

template <class Index, class Work>
void parallel_for(const blocked_range2d<Index>& range, const Work& work, simple_partitioner = {}) {
    std::vector<blocked_range2d<Index>> tiles;
    for (Index y = range.rows().begin(); y < range.rows().end(); y += range.tile)
        for (Index x = range.cols().begin(); x < range.cols().end(); x += range.tile)
            tiles.emplace_back(y, std::min(y + range.tile, range.rows().end()), range.tile, x,
                               std::min(x + range.tile, range.cols().end()), range.tile);
    on_threads(tiles.size(), [&](std::size_t i) { work(tiles[i]); });
}

}  // namespace tbb
