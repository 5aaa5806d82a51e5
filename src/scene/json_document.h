#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/result.h"

namespace heliodon::scene_file {

using Json = nlohmann::json;

/// Parses `text` strictly: no comments, no key twice in one object, finite numbers, at most
/// `deepest_nesting` levels. Syntax errors are located as name:line:column.
[[nodiscard]] Result<Json> parse_document(std::string_view text, const std::string& name);

inline constexpr std::size_t deepest_nesting = 256;

/// `path` of a member or element below `parent`: `$.nodes[3]["odd key"]`.
[[nodiscard]] std::string member_path(const std::string& parent, std::string_view key);
[[nodiscard]] std::string element_path(const std::string& parent, std::size_t index);

/// A value as messages show it: scalars (shortened), else `an object` or `a list of 3`.
[[nodiscard]] std::string describe(const Json& value);

}  // namespace heliodon::scene_file
