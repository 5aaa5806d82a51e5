#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

namespace heliodon::tests {

/// A file of the shared data (real models, scenes, external numbers): below HELIODON_SHARED, else beside
/// the source tree. Absent: empty, so that the test can skip; on CI that is a failure instead.
inline std::optional<std::filesystem::path> shared_path(std::string_view relative) {
    const char* variable = std::getenv("HELIODON_SHARED");
    const std::filesystem::path root =
        variable ? std::filesystem::path(variable) : std::filesystem::path(HELIODON_SOURCE_DIR) / ".." / "shared";
    const std::filesystem::path path = root / relative;
    if (std::filesystem::exists(path)) return path;
    if (std::getenv("CI")) ADD_FAILURE() << "shared data missing: " << path;
    return std::nullopt;
}

}  // namespace heliodon::tests
