#include "import/picture_files.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

namespace heliodon::tests {

std::string png(int width, int height, int channels, const std::vector<std::uint8_t>& texels) {
    std::string bytes;
    stbi_write_png_to_func(
        [](void* to, void* data, int size) {
            static_cast<std::string*>(to)->append(static_cast<char*>(data), std::size_t(size));
        },
        &bytes, width, height, channels, texels.data(), width * channels);
    return bytes;
}

}  // namespace heliodon::tests
