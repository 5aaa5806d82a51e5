#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace heliodon {

/// Allocates 16 bytes past the end: Embree's shared buffers are read in 16-byte steps, so that the same
/// host copy of a vertex array serves the tracer and the upload to the GPU.
template <class T>
struct PaddedAllocator {
    using value_type = T;
    PaddedAllocator() = default;
    template <class U>
    PaddedAllocator(const PaddedAllocator<U>&) {}

    T* allocate(std::size_t count) {
        return static_cast<T*>(::operator new(count * sizeof(T) + padding_bytes));
    }
    void deallocate(T* pointer, std::size_t) { ::operator delete(pointer); }

    template <class U>
    bool operator==(const PaddedAllocator<U>&) const {
        return true;
    }
    static constexpr std::size_t padding_bytes = 16;
};

template <class T>
using PaddedArray = std::vector<T, PaddedAllocator<T>>;

}  // namespace heliodon
