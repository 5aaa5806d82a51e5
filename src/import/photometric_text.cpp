#include "import/photometric_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "import/import_failure.h"

namespace heliodon::import {
namespace {

constexpr std::string_view blanks = " \t\v\f";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

/// One byte a character: photometric files say nothing in others that matters.
std::string narrow(std::string bytes) {
    if (bytes.starts_with("\xef\xbb\xbf")) return bytes.substr(3);
    const bool little = bytes.starts_with("\xff\xfe"), big = bytes.starts_with("\xfe\xff");
    if (!little && !big) return bytes;
    std::string text;
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        const char low = bytes[i + (little ? 0 : 1)], high = bytes[i + (little ? 1 : 0)];
        text += high == 0 ? low : '?';
    }
    return text;
}

/// For messages: short, and without control characters.
std::string shown(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string result;
    for (const char c : text.substr(0, longest)) result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    return result;
}

}  // namespace

PhotometricText::PhotometricText(std::string bytes, std::string name) : bytes_(narrow(std::move(bytes))), name_(std::move(name)) {
    std::string_view rest(bytes_);
    if (const std::size_t end = rest.find('\x1a'); end != std::string_view::npos) rest = rest.substr(0, end);
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
        lines_.push_back(trimmed(rest.substr(0, end)));
        rest.remove_prefix(std::min(rest.size(), end + (rest.substr(end).starts_with("\r\n") ? 2 : 1)));
    }
}

std::string PhotometricText::where() const { return fmt::format("{}:{}", name_, std::max<std::size_t>(next_, 1)); }

void PhotometricText::refuse(std::string_view expected, std::string_view found) const {
    import::refuse(where(), fmt::format("expected {}, found {}", expected, found));
}

std::string_view PhotometricText::line(std::string_view what) {
    if (at_end()) refuse(what, "the end of the file");
    rest_ = {};
    return lines_[next_++];
}

bool PhotometricText::has_words() {
    while (true) {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(separators_), rest_.size()));
        if (!rest_.empty()) return true;
        if (at_end()) return false;
        rest_ = lines_[next_++];
    }
}

std::string_view PhotometricText::word(std::string_view what) {
    if (!has_words()) refuse(what, "the end of the file");
    const std::size_t end = std::min(rest_.find_first_of(separators_), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
}

double PhotometricText::value_of(std::string_view word, std::string_view what) const {
    std::string text(word);
    if (separators_.find(',') == std::string_view::npos) std::replace(text.begin(), text.end(), ',', '.');
    // Fortran's exponents occur in old files.
    for (char& c : text)
        if (c == 'd' || c == 'D') c = 'e';
    const std::size_t sign = text.starts_with('+') ? 1 : 0;
    double value = 0;
    const auto [end, error] = std::from_chars(text.data() + sign, text.data() + text.size(), value);
    // The engines compute in single precision, with products of these.
    if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) < 1e15))
        refuse(what, fmt::format("\"{}\"", shown(word)));
    return value;
}

int PhotometricText::whole_of(double value, std::string_view what, int low, int high) const {
    if (!(value >= low && value <= high && value == std::floor(value)))
        refuse(fmt::format("{} (a whole number from {} to {})", what, low, high), fmt::format("{}", value));
    return static_cast<int>(value);
}

double PhotometricText::number(std::string_view what) { return value_of(word(what), what); }

double PhotometricText::number_line(std::string_view what, std::optional<double> if_empty) {
    const std::string_view text = line(what);
    if (text.empty() && if_empty) return *if_empty;
    const std::string_view before = std::exchange(separators_, blanks);
    const double value = value_of(text.substr(0, text.find_first_of(blanks)), what);
    separators_ = before;
    return value;
}

int PhotometricText::whole(std::string_view what, int low, int high) { return whole_of(number(what), what, low, high); }

int PhotometricText::whole_line(std::string_view what, int low, int high, std::optional<double> if_empty) {
    return whole_of(number_line(what, if_empty), what, low, high);
}

std::vector<double> PhotometricText::numbers(std::string_view what, std::size_t count, bool decimal_comma) {
    // Each takes a character and a separator at least: a count that cannot be true reserves nothing.
    if (count > bytes_.size()) refuse(fmt::format("{} {}s", count, what), "fewer characters in the whole file");
    separators_ = decimal_comma ? blanks : " \t\v\f,";
    std::vector<double> result;
    result.reserve(count);
    for (std::size_t i = 0; i < count; ++i) result.push_back(number(fmt::format("{} {} of {}", what, i + 1, count)));
    return result;
}

}  // namespace heliodon::import
