#include "app/cli/outputs.h"

#include <sys/resource.h>

#include "core/image_io.h"

namespace heliodon::cli {

Result<void> check_pictures_writable(const std::vector<std::string>& paths) {
    for (const std::string& path : paths)
        if (auto checked = check_writable(path); !checked) return checked;
    return {};
}

Result<void> check_text_writable(const std::filesystem::path& path) {
    return check_directory_writable(path);
}

Result<void> write_rendered(const std::filesystem::path& path, const Picture& picture, const DisplaySettings& settings,
                            const DisplayOptions& options) {
    if (!is_display_format(path)) return write_picture(path, picture);
    Picture display;
    display.image = shown(picture, settings, options);
    return write_picture(path, display);
}

std::uint64_t peak_rss_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace heliodon::cli
