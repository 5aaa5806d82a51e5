// Portable float maps (Debevec; "PF" or "Pf", size, scale, rows from the bottom; a negative scale means
// little-endian values).
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

#include "core/picture_codecs.h"

namespace heliodon::codecs {
namespace {

constexpr std::string_view blanks = " \t\r\n";

/// Takes the next word off `rest`, with the single blank that ends it.
std::string_view take_word(std::string_view& rest) {
    rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
    const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    return word;
}

template <class Number>
bool parse(std::string_view word, Number& number) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size();
}

float read_value(const char* bytes, bool swap) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    return std::bit_cast<float>(swap ? __builtin_bswap32(bits) : bits);
}

}  // namespace

Result<Picture> decode_pfm(std::string_view bytes) {
    std::string_view rest = bytes;
    const std::string_view magic = take_word(rest);
    if (magic != "PF" && magic != "Pf") return fail("", "expected a portable float map (PF or Pf)");
    int width = 0, height = 0;
    float scale = 0;
    const std::string_view words[] = {take_word(rest), take_word(rest), take_word(rest)};
    if (!parse(words[0], width) || !parse(words[1], height) || !parse(words[2], scale) || scale == 0.0f) {
        return fail("", fmt::format("expected width, height and scale, found \"{}\" \"{}\" \"{}\"",
                                    words[0].substr(0, 20), words[1].substr(0, 20), words[2].substr(0, 20)));
    }
    const int channels = magic == "PF" ? 3 : 1;
    if (auto checked = check_size(width, height, channels * 4, bytes.size(), 1); !checked) {
        return tl::unexpected(checked.error());
    }
    const std::size_t row = static_cast<std::size_t>(width) * channels;
    const std::size_t expected = row * height * sizeof(float);
    if (rest.size() < expected) {
        return fail("", fmt::format("truncated: expected {} bytes of pixels, found {}", expected, rest.size()));
    }
    const bool swap = (scale < 0.0f) != (std::endian::native == std::endian::little);
    Picture picture;
    picture.image = Image(width, height, channels);
    for (int y = 0; y < height; ++y) {
        const char* source = rest.data() + row * sizeof(float) * static_cast<std::size_t>(height - 1 - y);
        float* target = picture.image.pixels.data() + row * y;
        for (std::size_t i = 0; i < row; ++i) target[i] = read_value(source + i * sizeof(float), swap);
    }
    return picture;
}

Result<std::string> encode_pfm(const Image& image) {
    const bool colour = image.channels >= 3;
    const int channels = colour ? 3 : 1;
    std::string bytes = fmt::format("{}\n{} {}\n{}\n", colour ? "PF" : "Pf", image.width, image.height,
                                    std::endian::native == std::endian::little ? "-1.0" : "1.0");
    std::vector<float> row(static_cast<std::size_t>(image.width) * channels);
    bytes.reserve(bytes.size() + row.size() * sizeof(float) * image.height);
    for (int y = image.height - 1; y >= 0; --y) {
        for (int x = 0; x < image.width; ++x) {
            std::copy_n(&image.pixels[image.index(x, y)], channels, &row[static_cast<std::size_t>(x) * channels]);
        }
        bytes.append(reinterpret_cast<const char*>(row.data()), row.size() * sizeof(float));
    }
    return bytes;
}

}  // namespace heliodon::codecs
