#pragma once

#include <cstdint>
#include <iterator>
#include <map>
#include <optional>

namespace heliodon::realtime {

/// First-fit allocation of ranges from [0, capacity), neighbours merged on release. Holds no memory itself.
class RangeAllocator {
public:
    [[nodiscard]] std::uint64_t capacity() const { return capacity_; }
    [[nodiscard]] std::uint64_t used() const { return used_; }

    /// Makes [capacity(), capacity) available as well.
    void grow(std::uint64_t capacity) {
        if (capacity <= capacity_) return;
        add_free(capacity_, capacity - capacity_);
        capacity_ = capacity;
    }
    /// The start of a range of `size` > 0, or nothing when no hole is large enough.
    [[nodiscard]] std::optional<std::uint64_t> allocate(std::uint64_t size) {
        for (auto hole = free_.begin(); hole != free_.end(); ++hole) {
            if (hole->second < size) continue;
            const std::uint64_t start = hole->first;
            const std::uint64_t rest = hole->second - size;
            free_.erase(hole);
            if (rest > 0) free_.emplace(start + size, rest);
            used_ += size;
            return start;
        }
        return std::nullopt;
    }
    void release(std::uint64_t start, std::uint64_t size) {
        if (size == 0) return;
        used_ -= size;
        add_free(start, size);
    }

private:
    void add_free(std::uint64_t start, std::uint64_t size) {
        auto next = free_.lower_bound(start);
        if (next != free_.end() && start + size == next->first) {
            size += next->second;
            next = free_.erase(next);
        }
        if (next != free_.begin()) {
            const auto previous = std::prev(next);
            if (previous->first + previous->second == start) {
                previous->second += size;
                return;
            }
        }
        free_.emplace(start, size);
    }

    std::map<std::uint64_t, std::uint64_t> free_;  // start, size
    std::uint64_t capacity_ = 0, used_ = 0;
};

}  // namespace heliodon::realtime
