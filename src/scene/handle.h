#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace heliodon {

/// Names one object of a scene for as long as it lives. A handle to a removed object stays invalid even
/// when its slot is used again.
template <class Tag>
struct Handle {
    std::uint32_t index = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t generation = 0;
    auto operator<=>(const Handle&) const = default;
    [[nodiscard]] explicit operator bool() const { return index != std::numeric_limits<std::uint32_t>::max(); }
};

/// A table of values with stable handles and stable indices: removing leaves a hole that a later
/// insertion fills.
template <class T, class Tag>
class Slots {
public:
    using Id = Handle<Tag>;

    Id insert(T value) {
        if (!free_.empty()) {
            const std::uint32_t index = free_.back();
            free_.pop_back();
            slots_[index].value = std::move(value);
            ++count_;
            return {index, slots_[index].generation};
        }
        slots_.push_back({std::move(value), 0});
        ++count_;
        return {static_cast<std::uint32_t>(slots_.size() - 1), 0};
    }
    bool erase(Id id) {
        if (!contains(id)) return false;
        slots_[id.index].value.reset();
        ++slots_[id.index].generation;
        free_.push_back(id.index);
        --count_;
        return true;
    }
    [[nodiscard]] bool contains(Id id) const {
        return id.index < slots_.size() && slots_[id.index].generation == id.generation &&
               slots_[id.index].value.has_value();
    }
    /// The value, or null when the handle is stale.
    [[nodiscard]] T* find(Id id) { return contains(id) ? &*slots_[id.index].value : nullptr; }
    [[nodiscard]] const T* find(Id id) const { return contains(id) ? &*slots_[id.index].value : nullptr; }
    /// The value in a slot, or null for a hole.
    [[nodiscard]] const T* at(std::uint32_t index) const {
        return index < slots_.size() && slots_[index].value ? &*slots_[index].value : nullptr;
    }
    [[nodiscard]] Id id_at(std::uint32_t index) const { return {index, slots_[index].generation}; }
    /// One past the highest slot ever used; derived databases size their tables by it.
    [[nodiscard]] std::uint32_t capacity() const { return static_cast<std::uint32_t>(slots_.size()); }
    [[nodiscard]] std::size_t size() const { return count_; }

    /// Calls `visit(Id, const T&)` for every live value, in slot order.
    template <class Visit>
    void each(Visit&& visit) const {
        for (std::uint32_t i = 0; i < capacity(); ++i)
            if (slots_[i].value) visit(id_at(i), *slots_[i].value);
    }

private:
    struct Slot {
        std::optional<T> value;
        std::uint32_t generation = 0;
    };
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;
    std::size_t count_ = 0;
};

}  // namespace heliodon
