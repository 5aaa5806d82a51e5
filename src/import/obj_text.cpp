#include "import/obj_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace heliodon::import {

LineStream::int_type LineStream::underflow() {
    if (rest_.empty()) return traits_type::eof();
    current_.clear();
    line_ = next_line_;
    bool joined = true;
    while (joined && !rest_.empty()) {
        const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
        std::string_view line = rest_.substr(0, end);
        const bool both = rest_.substr(end).starts_with("\r\n");
        rest_.remove_prefix(std::min(rest_.size(), end + (both ? 2 : 1)));
        ++next_line_;
        joined = line.ends_with('\\');
        if (joined) line.remove_suffix(1);
        current_ += line;
        if (joined) current_ += ' ';
    }
    // tinyobjloader takes the text as C strings; what follows a zero byte would go unread.
    for (char& c : current_)
        if (c == '\0') c = '?';
    check_(current_, line_);
    current_ += '\n';
    setg(current_.data(), current_.data(), current_.data() + current_.size());
    return traits_type::to_int_type(current_[0]);
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
        const std::size_t begin = line.find_first_not_of(" \t");
        if (begin == std::string_view::npos) return words;
        line.remove_prefix(begin);
        const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
        words.push_back(line.substr(0, end));
        line.remove_prefix(end);
    }
}

std::optional<float> finite_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(float(value))) return std::nullopt;
    return float(value);
}

}  // namespace heliodon::import
