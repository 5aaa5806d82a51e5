#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/display_options.h"
#include "core/image.h"
#include "core/result.h"

namespace heliodon::cli {

/// Before any work is done: every picture's ending is known and its directory can be written to.
[[nodiscard]] Result<void> check_pictures_writable(const std::vector<std::string>& paths);
/// The same for a file of another kind (statistics).
[[nodiscard]] Result<void> check_text_writable(const std::filesystem::path& path);

/// Writes by ending: .exr, .hdr, .pfm as measured; .png, .jpg as the settings and options show it.
[[nodiscard]] Result<void> write_rendered(const std::filesystem::path& path, const Picture& picture,
                                          const DisplaySettings& settings, const DisplayOptions& options);

/// Peak resident memory of this process.
[[nodiscard]] std::uint64_t peak_rss_bytes();

}  // namespace heliodon::cli
