#include "app/cli/outputs.h"

#include <sys/resource.h>

#include "core/image_io.h"
#include "shading/tone.h"

namespace heliodon::cli {

Result<void> check_pictures_writable(const std::vector<std::string>& paths) {
    for (const std::string& path : paths)
        if (auto checked = check_writable(path); !checked) return checked;
    return {};
}

Result<void> check_text_writable(const std::filesystem::path& path) {
    return check_directory_writable(path);
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
