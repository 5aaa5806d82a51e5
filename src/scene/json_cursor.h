#pragma once

#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/math.h"
#include "scene/json_document.h"

namespace heliodon::scene_file {

/// Thrown and caught inside the scene file reader alone, which returns it as the one located Error.
struct Refusal {
    std::string path;  ///< JSON path
    std::string message;
};

/// Numbers a value may take.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_excluded = false;
    bool high_excluded = false;
    bool zero_excluded = false;

    [[nodiscard]] bool contains(double value) const;
    /// "a number", "a number at least 0", …
    [[nodiscard]] std::string describe() const;
};
inline constexpr Range any_number{};
inline constexpr Range not_negative{.low = 0};
inline constexpr Range positive{.low = 0, .low_excluded = true};
inline constexpr Range unit_interval{.low = 0, .high = 1};
inline constexpr Range not_zero{.zero_excluded = true};

/// A JSON value and its place. Every reading function refuses (throws Refusal) what it does not expect.
class JsonCursor {
public:
    JsonCursor(const Json& value, std::string path) : value_(&value), path_(std::move(path)) {}

    [[nodiscard]] const Json& json() const { return *value_; }
    [[nodiscard]] const std::string& path() const { return path_; }
    /// "expected `expected`, found …"
    [[noreturn]] void refuse(std::string_view expected) const;
    /// For what the format has and the program lacks.
    [[noreturn]] void refuse_as_unsupported(std::string_view feature, std::string_view instead) const;

    [[nodiscard]] float number(const Range& range = any_number) const;
    [[nodiscard]] int integer(int low, int high) const;
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] std::string string() const;
    /// A string that is not empty.
    [[nodiscard]] std::string name() const;
    [[nodiscard]] std::filesystem::path file() const;
    [[nodiscard]] glm::vec3 vector(const Range& range = any_number) const;
    /// A vector with a length, made unit length.
    [[nodiscard]] glm::vec3 unit_vector() const;
    /// One number stands for three equal ones.
    [[nodiscard]] glm::vec3 number_or_vector(const Range& range) const;
    [[nodiscard]] std::vector<JsonCursor> elements() const;
    /// (key, value) of an object whose keys are names.
    [[nodiscard]] std::vector<std::pair<std::string, JsonCursor>> members() const;

    template <class Value>
    [[nodiscard]] Value one_of(std::initializer_list<std::pair<std::string_view, Value>> choices) const {
        std::string expected;
        for (const auto& [text, value] : choices) {
            if (value_->is_string() && value_->get_ref<const std::string&>() == text) return value;
            if (!expected.empty()) expected += ", ";
            expected.append("\"").append(text).append("\"");
        }
        refuse((choices.size() > 1 ? "one of " : "") + expected);
    }

private:
    const Json* value_;
    std::string path_;
};

/// Reads an object's members and remembers which keys it was asked for: `finish` refuses the others.
class ObjectReader {
public:
    explicit ObjectReader(const JsonCursor& object);

    [[nodiscard]] const JsonCursor& cursor() const { return object_; }
    [[nodiscard]] std::optional<JsonCursor> find(std::string_view key);
    [[nodiscard]] JsonCursor require(std::string_view key);
    void finish() const;

    void read(std::string_view key, float& field, const Range& range = any_number) {
        if (const auto value = find(key)) field = value->number(range);
    }
    void read(std::string_view key, int& field, int low, int high) {
        if (const auto value = find(key)) field = value->integer(low, high);
    }
    void read(std::string_view key, bool& field) {
        if (const auto value = find(key)) field = value->boolean();
    }
    void read(std::string_view key, glm::vec3& field, const Range& range = any_number) {
        if (const auto value = find(key)) field = value->vector(range);
    }
    void read_degrees(std::string_view key, float& field_rad, const Range& range_deg) {
        if (const auto value = find(key)) field_rad = glm::radians(value->number(range_deg));
    }
    void read(std::string_view key, std::filesystem::path& field) {
        if (const auto value = find(key)) field = value->file();
    }

private:
    JsonCursor object_;
    std::vector<std::string_view> known_;
};

}  // namespace heliodon::scene_file
