#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>

#include "shading/ggx.h"

namespace heliodon::shading {

/// What alpha_coordinate() maps to `row` of `rows`.
[[nodiscard]] inline float alpha_of_row(std::size_t row, std::size_t rows) {
    const double smallest = std::sqrt(static_cast<double>(ggx_smallest_alpha));
    const double root = smallest + (1.0 - smallest) * static_cast<double>(row) / static_cast<double>(rows - 1);
    return static_cast<float>(root * root);
}

/// Calls `fill` for each row of a table, on all cores; rows stand for themselves.
void each_table_row(std::size_t rows, const std::function<void(std::size_t row)>& fill);

/// Fills the parts of shading_tables() that ggx_anisotropic.h and sheen.h look up; `table` is the whole.
void fill_extended_tables(std::span<float> table);

}  // namespace heliodon::shading
