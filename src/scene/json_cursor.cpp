#include "scene/json_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace heliodon::scene_file {

bool Range::contains(double value) const {
    if (zero_excluded && value == 0) return false;
    return (low_excluded ? value > low : value >= low) && (high_excluded ? value < high : value <= high);
}

std::string Range::describe() const {
    std::string text = zero_excluded ? "a number other than 0" : "a number";
    if (std::isfinite(low)) text += fmt::format(" {} {}", low_excluded ? "above" : "at least", low);
    if (std::isfinite(high))
        text += fmt::format("{} {} {}", std::isfinite(low) ? " and" : "", high_excluded ? "below" : "at most", high);
    return text;
}

void JsonCursor::refuse(std::string_view expected) const {
    throw Refusal{path_, fmt::format("expected {}, found {}", expected, describe(*value_))};
}

void JsonCursor::refuse_as_unsupported(std::string_view feature, std::string_view instead) const {
    throw Refusal{path_,
                  fmt::format("{} are not supported yet: expected {}, found {}", feature, instead, describe(*value_))};
}

float JsonCursor::number(const Range& range) const {
    if (!value_->is_number()) refuse(range.describe());
    // The range holds for the float too: 1e-60 is above 0 only as a double.
    const auto result = static_cast<float>(value_->get<double>());
    if (!std::isfinite(result)) refuse("a number that single precision holds");
    if (!range.contains(value_->get<double>()) || !range.contains(result)) refuse(range.describe());
    return result;
}

int JsonCursor::integer(int low, int high) const {
    const double number = value_->is_number() ? value_->get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!(number >= low && number <= high && number == std::floor(number)))
        refuse(fmt::format("a whole number from {} to {}", low, high));
    return static_cast<int>(number);
}

bool JsonCursor::boolean() const {
    if (!value_->is_boolean()) refuse("true or false");
    return value_->get<bool>();
}

std::string JsonCursor::string() const {
    if (!value_->is_string()) refuse("a string");
    return value_->get<std::string>();
}

std::string JsonCursor::name() const {
    if (!value_->is_string() || value_->get_ref<const std::string&>().empty()) refuse("a name");
    return value_->get<std::string>();
}

std::filesystem::path JsonCursor::file() const {
    const bool usable = value_->is_string() && !value_->get_ref<const std::string&>().empty() &&
                        value_->get_ref<const std::string&>().find('\0') == std::string::npos;
    if (!usable) refuse("the path of a file");
    return value_->get<std::string>();
}

glm::vec3 JsonCursor::vector(const Range& range) const {
    if (!value_->is_array() || value_->size() != 3) refuse("a list of 3 numbers");
    glm::vec3 result;
    for (std::size_t i = 0; i < 3; ++i)
        result[static_cast<int>(i)] = JsonCursor((*value_)[i], element_path(path_, i)).number(range);
    return result;
}

glm::vec3 JsonCursor::unit_vector() const {
    const glm::dvec3 direction = vector();
    const double length = glm::length(direction);
    if (!(length > 0)) throw Refusal{path_, "expected a direction, found a vector of length 0"};
    return glm::vec3(direction / length);
}

glm::vec3 JsonCursor::number_or_vector(const Range& range) const {
    if (value_->is_number()) return glm::vec3(number(range));
    if (!value_->is_array() || value_->size() != 3) refuse("a number or a list of 3 numbers");
    return vector(range);
}

std::vector<JsonCursor> JsonCursor::elements() const {
    if (!value_->is_array()) refuse("a list");
    std::vector<JsonCursor> result;
    for (std::size_t i = 0; i < value_->size(); ++i) result.emplace_back((*value_)[i], element_path(path_, i));
    return result;
}

std::vector<std::pair<std::string, JsonCursor>> JsonCursor::members() const {
    if (!value_->is_object()) refuse("an object");
    std::vector<std::pair<std::string, JsonCursor>> result;
    for (const auto& [key, value] : value_->items())
        result.emplace_back(key, JsonCursor(value, member_path(path_, key)));
    return result;
}

ObjectReader::ObjectReader(const JsonCursor& object) : object_(object) {
    if (!object.json().is_object()) object.refuse("an object");
}

std::optional<JsonCursor> ObjectReader::find(std::string_view key) {
    known_.push_back(key);
    const auto found = object_.json().find(std::string(key));
    if (found == object_.json().end()) return std::nullopt;
    return JsonCursor(*found, member_path(object_.path(), key));
}

JsonCursor ObjectReader::require(std::string_view key) {
    if (auto found = find(key)) return *std::move(found);
    throw Refusal{object_.path(), fmt::format("expected the key \"{}\", found none", key)};
}

void ObjectReader::finish() const {
    for (const auto& [key, value] : object_.json().items()) {
        if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
        throw Refusal{member_path(object_.path(), key),
                      fmt::format("unknown key; expected {}", fmt::join(known_, ", "))};
    }
}

}  // namespace heliodon::scene_file
