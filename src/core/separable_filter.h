#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/parallel.h"

namespace heliodon {

/// One channel of a picture, rows from the top.
template <class Value>
struct Plane {
    int width = 0, height = 0;
    std::vector<Value> values;

    Plane(int width_, int height_)
        : width(width_),
          height(height_),
          values(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}
    [[nodiscard]] Value* row(int y) { return values.data() + static_cast<std::size_t>(y) * width; }
    [[nodiscard]] const Value* row(int y) const { return values.data() + static_cast<std::size_t>(y) * width; }
};

/// Rows a parallel piece of picture work.
inline constexpr std::size_t rows_per_piece = 16;

/// Calls `body(y)` for every row, in parallel.
template <class Body>
void parallel_rows(int height, Body&& body) {
    parallel_for(static_cast<std::size_t>(height), rows_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
    });
}

/// Sum over the kernels' offsets of horizontal[i] · vertical[j] · source(x + i, y + j), where both kernels have
/// odd lengths about their centres and the source's border pixels go on for ever.
template <class Value>
Plane<Value> filter_separable(const Plane<Value>& source, std::span<const Value> horizontal,
                              std::span<const Value> vertical) {
    const int width = source.width, height = source.height;
    const int radius_x = static_cast<int>(horizontal.size() / 2), radius_y = static_cast<int>(vertical.size() / 2);
    Plane<Value> rows(width, height), result(width, height);
    parallel_rows(height, [&](int y) {
        std::vector<Value> padded(static_cast<std::size_t>(width + 2 * radius_x));
        const Value* in = source.row(y);
        std::fill_n(padded.begin(), radius_x, in[0]);
        std::copy_n(in, width, padded.begin() + radius_x);
        std::fill_n(padded.begin() + radius_x + width, radius_x, in[width - 1]);
        Value* out = rows.row(y);
        for (std::size_t tap = 0; tap < horizontal.size(); ++tap) {
            const Value weight = horizontal[tap];
            const Value* shifted = padded.data() + tap;
            for (int x = 0; x < width; ++x) out[x] += weight * shifted[x];
        }
    });
    parallel_rows(height, [&](int y) {
        Value* out = result.row(y);
        for (int tap = -radius_y; tap <= radius_y; ++tap) {
            const Value weight = vertical[static_cast<std::size_t>(tap + radius_y)];
            const Value* in = rows.row(std::clamp(y + tap, 0, height - 1));
            for (int x = 0; x < width; ++x) out[x] += weight * in[x];
        }
    });
    return result;
}

}  // namespace heliodon
