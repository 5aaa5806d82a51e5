#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace heliodon::import {

/// Hands a text to tinyobjloader line by line, so that the number of the line it is reading is known when
/// it calls back. A backslash at a line's end joins it to the next. Every line is shown to `check` first,
/// because tinyobjloader reads what is no number as 0.
class LineStream : public std::streambuf {
public:
    using Check = std::function<void(std::string_view line, int number)>;
    LineStream(std::string_view text, Check check) : rest_(text), check_(std::move(check)) {}
    [[nodiscard]] int line() const { return line_; }

protected:
    int_type underflow() override;

private:
    std::string_view rest_;
    Check check_;
    std::string current_;
    int line_ = 0;
    int next_line_ = 1;
};

/// The words of a line.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view line);
/// A finite number, or nothing.
[[nodiscard]] std::optional<float> finite_number(std::string_view word);

}  // namespace heliodon::import
