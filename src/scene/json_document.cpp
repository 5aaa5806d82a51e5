#include "scene/json_document.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace heliodon::scene_file {
namespace {

constexpr std::size_t longest_quote = 60;

/// "line:column" of the last of the first `position` bytes, both from 1.
std::string line_and_column(std::string_view text, std::size_t position) {
    const std::string_view before = text.substr(0, std::min(position, text.size()));
    const std::string_view until_last = before.substr(0, before.empty() ? 0 : before.size() - 1);
    const auto line = 1 + std::count(until_last.begin(), until_last.end(), '\n');
    const std::size_t newline = until_last.rfind('\n');
    const std::size_t column = until_last.size() - (newline == std::string_view::npos ? 0 : newline + 1) + 1;
    return std::to_string(line) + ":" + std::to_string(column);
}

/// The library's message without its own error code and place.
std::string plain_message(std::string_view message) {
    for (const std::string_view prefix : {"[json.exception", "parse error"}) {
        if (!message.starts_with(prefix)) continue;
        const std::string_view separator = prefix.front() == '[' ? "] " : ": ";
        const std::size_t end = message.find(separator);
        if (end != std::string_view::npos) message.remove_prefix(end + separator.size());
    }
    constexpr std::size_t longest = 240;
    return message.size() <= longest ? std::string(message) : std::string(message.substr(0, longest)) + "…";
}

/// Builds the document from parser events; refuses what a plain parse would let pass.
class DocumentBuilder : public nlohmann::json_sax<Json> {
public:
    DocumentBuilder(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    Json document;
    std::optional<Error> error;

    bool null() override { return put(nullptr) != nullptr; }
    bool boolean(bool value) override { return put(value) != nullptr; }
    bool number_integer(number_integer_t value) override { return put(value) != nullptr; }
    bool number_unsigned(number_unsigned_t value) override { return put(value) != nullptr; }
    bool number_float(number_float_t value, const string_t&) override { return put(value) != nullptr; }
    bool string(string_t& value) override { return put(std::move(value)) != nullptr; }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(Json::object()); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& key) override {
        keys_.back() = key;
        if (!open_.back()->contains(key)) return true;
        error = Error{name_ + ": " + path(open_.size() - 1), "expected each key once, found \"" + key + "\" twice"};
        return false;
    }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& exception) override {
        error = Error{name_ + ":" + line_and_column(text_, position), plain_message(exception.what())};
        return false;
    }

private:
    Json* put(Json value) {
        if (open_.empty()) return &(document = std::move(value));
        Json& container = *open_.back();
        if (container.is_array()) return &container.emplace_back(std::move(value));
        return &(container[keys_.back()] = std::move(value));
    }
    bool open(Json container) {
        if (open_.size() >= deepest_nesting) {
            error =
                Error{name_, "expected at most " + std::to_string(deepest_nesting) + " levels of nesting, found more"};
            return false;
        }
        open_.push_back(put(std::move(container)));
        keys_.emplace_back();
        return true;
    }
    bool close() {
        open_.pop_back();
        keys_.pop_back();
        return true;
    }
    /// Of the container `level` levels below the document.
    [[nodiscard]] std::string path(std::size_t level) const {
        std::string result = "$";
        for (std::size_t i = 0; i < level; ++i)
            result = open_[i]->is_array() ? element_path(result, open_[i]->size() - 1) : member_path(result, keys_[i]);
        return result;
    }

    std::string_view text_;
    const std::string& name_;
    std::vector<Json*> open_;
    std::vector<std::string> keys_;  ///< of each open object, the member being read
};

bool is_plain_key(std::string_view key) {
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789-";
    return !key.empty() && key.find_first_not_of(letters) == std::string_view::npos;
}

}  // namespace

Result<Json> parse_document(std::string_view text, const std::string& name) {
    DocumentBuilder builder(text, name);
    try {
        const bool whole = Json::sax_parse(text.begin(), text.end(), &builder);
        if (whole && !builder.error) return std::move(builder.document);
    } catch (const std::exception& exception) {
        return fail(name, plain_message(exception.what()));
    }
    return tl::unexpected<Error>(builder.error.value_or(Error{name, "expected JSON, found something else"}));
}

std::string member_path(const std::string& parent, std::string_view key) {
    if (is_plain_key(key)) return parent + "." + std::string(key);
    return parent + "[" + describe(Json(std::string(key))) + "]";
}

std::string element_path(const std::string& parent, std::size_t index) {
    return parent + "[" + std::to_string(index) + "]";
}

std::string describe(const Json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return "a list of " + std::to_string(value.size());
    const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() <= longest_quote ? text : text.substr(0, longest_quote) + "…";
}

}  // namespace heliodon::scene_file
