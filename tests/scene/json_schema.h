#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace heliodon::tests {

/// Validates `value` by the keywords of JSON Schema 2020-12 that docs/scene.schema.json uses; any other keyword
/// is reported as a fault of the schema. Returns the first violation, nothing for a valid document.
[[nodiscard]] std::optional<std::string> schema_violation(const nlohmann::json& schema, const nlohmann::json& value);

}  // namespace heliodon::tests
