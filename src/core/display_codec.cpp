// 8- and 16-bit display pictures through stb, once their containers are known to be sound.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "core/picture_codecs.h"
#include "core/units.h"

// Private copies: another library in the program may carry stb too.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 65536
#define STBI_FAILURE_USERMSG
#include <stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace heliodon::codecs {
namespace {

struct Freed {
    void operator()(void* memory) const { stbi_image_free(memory); }
};

/// Alpha is linear already: the last of two or four channels.
bool is_alpha(int channel, int channels) {
    return channels % 2 == 0 && channel == channels - 1;
}

template <class Value>
Image linear_image(const Value* values, int width, int height, int channels) {
    constexpr auto highest = static_cast<float>(std::numeric_limits<Value>::max());
    std::vector<float> decoded(std::size_t{1} << (8 * sizeof(Value)));
    for (std::size_t i = 0; i < decoded.size(); ++i) decoded[i] = units::srgb_decode(static_cast<float>(i) / highest);
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const bool alpha = is_alpha(static_cast<int>(i % channels), channels);
        image.pixels[i] = alpha ? static_cast<float>(values[i]) / highest : decoded[values[i]];
    }
    return image;
}

Result<Picture> decode_display(std::string_view bytes, std::int64_t bytes_per_pixel, std::int64_t max_expansion) {
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) return fail("", "larger than 2 GiB");
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels)) {
        return fail("", fmt::format("damaged picture: {}", stbi_failure_reason()));
    }
    if (auto checked = check_size(width, height, bytes_per_pixel, bytes.size(), max_expansion); !checked) {
        return tl::unexpected(checked.error());
    }
    Picture picture;
    if (stbi_is_16_bit_from_memory(data, size)) {
        const std::unique_ptr<stbi_us, Freed> values(
            stbi_load_16_from_memory(data, size, &width, &height, &channels, 0));
        if (values) picture.image = linear_image(values.get(), width, height, channels);
    } else {
        const std::unique_ptr<stbi_uc, Freed> values(stbi_load_from_memory(data, size, &width, &height, &channels, 0));
        if (values) picture.image = linear_image(values.get(), width, height, channels);
    }
    if (picture.image.pixels.empty()) return fail("", fmt::format("damaged picture: {}", stbi_failure_reason()));
    return picture;
}

/// 8-bit values rounded to nearest, with `channels` of the image's; what is not a number becomes black.
std::vector<std::uint8_t> quantized(const Image& image, int channels) {
    std::vector<std::uint8_t> values;
    values.reserve(static_cast<std::size_t>(image.width) * image.height * channels);
    for (std::size_t pixel = 0; pixel < image.pixels.size(); pixel += image.channels) {
        for (int c = 0; c < channels; ++c) {
            const float value = image.pixels[pixel + c];
            values.push_back(value > 0.0f ? static_cast<std::uint8_t>(std::lround(std::min(value, 1.0f) * 255.0f)) : 0);
        }
    }
    return values;
}

void append(void* target, void* data, int size) {
    static_cast<std::string*>(target)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

Result<Picture> decode_png(std::string_view bytes) {
    const Result<int> bytes_per_pixel = check_png(bytes);
    if (!bytes_per_pixel) return tl::unexpected(bytes_per_pixel.error());
    return decode_display(bytes, *bytes_per_pixel, 1032);  // deflate's highest ratio
}

Result<Picture> decode_jpeg(std::string_view bytes) {
    if (auto checked = check_jpeg(bytes); !checked) return tl::unexpected(checked.error());
    return decode_display(bytes, 1, 512);  // at least one bit for each block of 8 × 8
}

Result<std::string> encode_png(const Image& image) {
    const std::vector<std::uint8_t> values = quantized(image, image.channels);
    std::string bytes;
    if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, image.channels, values.data(),
                                image.width * image.channels)) {
        return fail("", "cannot encode as PNG");
    }
    return bytes;
}

Result<std::string> encode_jpeg(const Image& image) {
    constexpr int quality = 95;
    const int channels = image.channels >= 3 ? 3 : 1;
    const std::vector<std::uint8_t> values = quantized(image, channels);
    std::string bytes;
    if (!stbi_write_jpg_to_func(append, &bytes, image.width, image.height, channels, values.data(), quality)) {
        return fail("", "cannot encode as JPEG");
    }
    return bytes;
}

}  // namespace heliodon::codecs
