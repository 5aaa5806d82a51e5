#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace heliodon::import {

/// The text of a photometric file as lines and numbers, each of which knows its line. Line ends of all systems, marks of
/// byte order, UTF-16 and a final Ctrl-Z are taken in. What is not as expected throws ImportFailure.
class PhotometricText {
public:
    PhotometricText(std::string bytes, std::string name);
    PhotometricText(const PhotometricText&) = delete;
    PhotometricText& operator=(const PhotometricText&) = delete;

    [[nodiscard]] std::span<const std::string_view> lines() const { return lines_; }
    [[nodiscard]] bool at_end() const { return next_ >= lines_.size(); }
    /// The next line without blanks at its ends; `what` is expected there.
    [[nodiscard]] std::string_view line(std::string_view what);

    /// The next number, whichever line it is on. Commas separate numbers.
    [[nodiscard]] double number(std::string_view what);
    /// The one number of the next line, by itself or before other words; its comma is a decimal one. Empty lines read as
    /// `if_empty` where given.
    [[nodiscard]] double number_line(std::string_view what, std::optional<double> if_empty = std::nullopt);
    [[nodiscard]] int whole(std::string_view what, int low, int high);
    [[nodiscard]] int whole_line(std::string_view what, int low, int high, std::optional<double> if_empty = std::nullopt);
    /// `count` numbers.
    [[nodiscard]] std::vector<double> numbers(std::string_view what, std::size_t count, bool decimal_comma);
    /// Whether more numbers could follow.
    [[nodiscard]] bool has_words();

    /// File and line of what was read last.
    [[nodiscard]] std::string where() const;
    /// "expected …, found …" at what was read last.
    [[noreturn]] void refuse(std::string_view expected, std::string_view found) const;
    [[nodiscard]] const std::string& name() const { return name_; }

private:
    [[nodiscard]] std::string_view word(std::string_view what);
    [[nodiscard]] double value_of(std::string_view word, std::string_view what) const;
    [[nodiscard]] int whole_of(double value, std::string_view what, int low, int high) const;

    std::string bytes_, name_;
    std::vector<std::string_view> lines_;
    std::size_t next_ = 0;       ///< the line that begins next
    std::string_view rest_;      ///< of the line before it
    std::string_view separators_ = " \t\v\f,";
};

}  // namespace heliodon::import
