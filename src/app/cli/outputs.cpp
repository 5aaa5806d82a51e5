#include "app/cli/outputs.h"

#include <sys/resource.h>
#include <unistd.h>

#include "core/image_io.h"
#include "shading/tone.h"

namespace heliodon::cli {

Result<void> check_pictures_writable(const std::vector<std::string>& paths) {
    for (const std::string& path : paths)
        if (auto checked = check_writable(path); !checked) return checked;
    return {};
}

Result<void> check_text_writable(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path directory = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(directory, error))
        return fail(path.string(), "cannot write: no directory \"" + directory.string() + "\"");
    if (std::filesystem::is_directory(path, error)) return fail(path.string(), "cannot write: it is a directory");
    if (access(directory.c_str(), W_OK) != 0)
        return fail(path.string(), "cannot write: directory \"" + directory.string() + "\" is not writable");
    return {};
}

Result<void> write_rendered(const std::filesystem::path& path, const Picture& picture) {
    if (!is_display_format(path)) return write_picture(path, picture);
    Picture shown;
    shown.image = Image(picture.image.width, picture.image.height, 3);
    const float scale = shading::exposure_scale(picture.ev100);
    for (int y = 0; y < shown.image.height; ++y)
        for (int x = 0; x < shown.image.width; ++x) {
            const glm::vec3 color = shading::srgb_encode_rgb(shading::tone_hable(picture.image.rgb(x, y) * scale));
            for (int c = 0; c < 3; ++c) shown.image.at(x, y, c) = color[c];
        }
    return write_picture(path, shown);
}

std::uint64_t peak_rss_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace heliodon::cli
