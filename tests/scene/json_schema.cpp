#include "json_schema.h"

#include <cmath>
#include <regex>
#include <set>

namespace heliodon::tests {
namespace {

using nlohmann::json;

/// Set on any keyword that this validator does not know, so that no rule passes unread.
const std::set<std::string> known_keywords{"$schema",
                                           "title",
                                           "description",
                                           "$defs",
                                           "$ref",
                                           "type",
                                           "properties",
                                           "required",
                                           "additionalProperties",
                                           "items",
                                           "enum",
                                           "const",
                                           "allOf",
                                           "anyOf",
                                           "oneOf",
                                           "not",
                                           "if",
                                           "then",
                                           "dependentSchemas",
                                           "minItems",
                                           "maxItems",
                                           "minimum",
                                           "maximum",
                                           "exclusiveMinimum",
                                           "exclusiveMaximum",
                                           "minLength",
                                           "pattern"};

class Validator {
public:
    explicit Validator(const json& root) : root_(root) {}

    using Violation = std::optional<std::string>;

    Violation check(const json& schema, const json& value, const std::string& at) const {
        if (schema.is_boolean()) return schema.get<bool>() ? Violation{} : Violation{at + ": not allowed"};
        for (const auto& [keyword, rule] : schema.items())
            if (!known_keywords.contains(keyword)) return "schema: unknown keyword " + keyword;
        for (const auto part : {&Validator::check_value, &Validator::check_number, &Validator::check_array,
                                &Validator::check_object, &Validator::check_combination})
            if (auto violation = (this->*part)(schema, value, at)) return violation;
        return {};
    }

private:
    bool valid(const json& schema, const json& value) const { return !check(schema, value, ""); }

    static bool has_type(const std::string& type, const json& value) {
        if (type == "object") return value.is_object();
        if (type == "array") return value.is_array();
        if (type == "string") return value.is_string();
        if (type == "boolean") return value.is_boolean();
        if (type == "number") return value.is_number();
        if (type == "integer") return value.is_number() && std::floor(value.get<double>()) == value.get<double>();
        return false;
    }

    Violation check_value(const json& schema, const json& value, const std::string& at) const {
        if (schema.contains("type") && !has_type(schema["type"], value))
            return at + ": not of type " + schema["type"].dump();
        if (schema.contains("const") && value != schema["const"]) return at + ": not " + schema["const"].dump();
        if (schema.contains("enum")) {
            bool found = false;
            for (const json& choice : schema["enum"]) found = found || value == choice;
            if (!found) return at + ": not one of " + schema["enum"].dump();
        }
        if (!value.is_string()) return {};
        const std::string& text = value.get_ref<const std::string&>();
        if (schema.contains("minLength") && text.size() < schema["minLength"]) return at + ": too short";
        if (schema.contains("pattern") && !std::regex_search(text, std::regex(schema["pattern"].get<std::string>())))
            return at + ": does not match the pattern";
        return {};
    }

    Violation check_number(const json& schema, const json& value, const std::string& at) const {
        if (!value.is_number()) return {};
        const double number = value.get<double>();
        if (schema.contains("minimum") && number < schema["minimum"]) return at + ": below the minimum";
        if (schema.contains("maximum") && number > schema["maximum"]) return at + ": above the maximum";
        if (schema.contains("exclusiveMinimum") && number <= schema["exclusiveMinimum"]) return at + ": too small";
        if (schema.contains("exclusiveMaximum") && number >= schema["exclusiveMaximum"]) return at + ": too large";
        return {};
    }

    Violation check_array(const json& schema, const json& value, const std::string& at) const {
        if (!value.is_array()) return {};
        if (schema.contains("minItems") && value.size() < schema["minItems"]) return at + ": too few items";
        if (schema.contains("maxItems") && value.size() > schema["maxItems"]) return at + ": too many items";
        if (!schema.contains("items")) return {};
        for (std::size_t i = 0; i < value.size(); ++i)
            if (auto violation = check(schema["items"], value[i], at + "[" + std::to_string(i) + "]")) return violation;
        return {};
    }

    Violation check_object(const json& schema, const json& value, const std::string& at) const {
        if (!value.is_object()) return {};
        for (const json& key : schema.value("required", json::array()))
            if (!value.contains(key.get<std::string>())) return at + ": without " + key.dump();
        const json properties = schema.value("properties", json::object());
        for (const auto& [key, member] : value.items()) {
            const std::string below = at + "." + key;
            if (properties.contains(key)) {
                if (auto violation = check(properties[key], member, below)) return violation;
            } else if (schema.contains("additionalProperties")) {
                if (auto violation = check(schema["additionalProperties"], member, below)) return violation;
            }
        }
        const json dependents = schema.value("dependentSchemas", json::object());
        for (const auto& [key, dependent] : dependents.items())
            if (value.contains(key))
                if (auto violation = check(dependent, value, at)) return violation;
        return {};
    }

    Violation check_combination(const json& schema, const json& value, const std::string& at) const {
        if (schema.contains("$ref")) {
            const std::string reference = schema["$ref"];
            if (auto violation = check(root_.at(json::json_pointer(reference.substr(1))), value, at)) return violation;
        }
        for (const json& every : schema.value("allOf", json::array()))
            if (auto violation = check(every, value, at)) return violation;
        if (schema.contains("anyOf") && matches(schema["anyOf"], value) == 0) return at + ": matches none of anyOf";
        if (schema.contains("oneOf") && matches(schema["oneOf"], value) != 1) return at + ": matches not one of oneOf";
        if (schema.contains("not") && valid(schema["not"], value)) return at + ": matches what it must not";
        if (schema.contains("if") && valid(schema["if"], value)) return check(schema["then"], value, at);
        return {};
    }

    int matches(const json& choices, const json& value) const {
        int count = 0;
        for (const json& choice : choices) count += valid(choice, value) ? 1 : 0;
        return count;
    }

    const json& root_;
};

}  // namespace

std::optional<std::string> schema_violation(const json& schema, const json& value) {
    return Validator(schema).check(schema, value, "$");
}

}  // namespace heliodon::tests
