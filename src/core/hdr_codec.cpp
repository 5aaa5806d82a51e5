// Radiance RGBE pictures (Ward 1991, "Real Pixels", Graphics Gems II; run-length encoding as Radiance 2.x
// writes it). A shared exponent over three 8-bit mantissas: value = mantissa · 2^(e − 136).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "core/picture_codecs.h"

namespace heliodon::codecs {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;
constexpr int exponent_bias = 128 + 8;

std::string_view take_line(std::string_view& rest) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

struct Header {
    int width = 0, height = 0;
    float exposure = 1.0f;
    bool bottom_up = false;
};

Result<Header> read_header(std::string_view& rest) {
    Header header;
    const std::string_view magic = take_line(rest);
    if (magic != "#?RADIANCE" && magic != "#?RGBE") return fail("", "expected a Radiance picture (#?RADIANCE)");
    for (std::string_view line = take_line(rest); !line.empty(); line = take_line(rest)) {
        if (rest.empty()) return fail("", "truncated: the header does not end");
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") {
            return fail("", fmt::format("expected FORMAT=32-bit_rle_rgbe, found {}", line.substr(0, 40)));
        }
        if (line.starts_with("EXPOSURE=")) {
            std::string_view value = line.substr(9);
            value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
            float factor = 0;
            if (std::from_chars(value.data(), value.data() + value.size(), factor).ec != std::errc() ||
                !(factor > 0.0f)) {
                return fail("", fmt::format("expected a positive EXPOSURE, found \"{}\"", value.substr(0, 20)));
            }
            header.exposure *= factor;  // the header may hold several; they multiply
        }
    }
    const std::string size(take_line(rest).substr(0, 80));
    std::array<char, 2> y_sign{}, x_sign{};
    if (std::sscanf(size.c_str(), "%1[-+]Y %d %1[+]X %d", y_sign.data(), &header.height, x_sign.data(),
                    &header.width) != 4) {
        return fail("", fmt::format("expected a size \"-Y height +X width\", found \"{}\"", size));
    }
    header.bottom_up = y_sign[0] == '+';
    return header;
}

/// Reads the pixel bytes; every function returns false when the data end early or contradict themselves.
class Scanlines {
public:
    explicit Scanlines(std::string_view bytes) : rest_(bytes) {}

    bool read(std::vector<Rgbe>& line) {
        const std::size_t width = line.size();
        const bool run_length =
            width >= 8 && width < 32768 && rest_.size() >= 4 && byte(0) == 2 && byte(1) == 2 && byte(2) < 128;
        if (!run_length) return read_flat(line);
        if ((std::size_t{byte(2)} << 8 | byte(3)) != width) return false;
        rest_.remove_prefix(4);
        for (int channel = 0; channel < 4; ++channel) {
            if (!read_channel(line, channel)) return false;
        }
        return true;
    }

private:
    [[nodiscard]] std::uint8_t byte(std::size_t i) const { return static_cast<std::uint8_t>(rest_[i]); }

    bool read_channel(std::vector<Rgbe>& line, int channel) {
        for (std::size_t x = 0; x < line.size();) {
            if (rest_.size() < 2) return false;
            const bool run = byte(0) > 128;
            const std::size_t count = run ? byte(0) - 128 : byte(0);
            const std::size_t taken = run ? 2 : 1 + count;
            if (count == 0 || count > line.size() - x || rest_.size() < taken) return false;
            for (std::size_t i = 0; i < count; ++i) line[x + i][channel] = byte(run ? 1 : 1 + i);
            rest_.remove_prefix(taken);
            x += count;
        }
        return true;
    }

    /// Pixels one by one; the first encoding marks repeats of the pixel before by mantissas of 1 1 1.
    bool read_flat(std::vector<Rgbe>& line) {
        int shift = 0;
        for (std::size_t x = 0; x < line.size();) {
            if (rest_.size() < 4) return false;
            const Rgbe pixel{byte(0), byte(1), byte(2), byte(3)};
            rest_.remove_prefix(4);
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
                line[x++] = pixel;
                shift = 0;
                continue;
            }
            if (x == 0 || shift > 16) return false;
            const std::size_t count = std::size_t{pixel[3]} << shift;
            if (count > line.size() - x) return false;
            std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(x), count, line[x - 1]);
            x += count;
            shift += 8;
        }
        return true;
    }

    std::string_view rest_;
};

Rgbe encode(const float* rgb) {
    std::array<float, 3> value;
    for (int c = 0; c < 3; ++c) {
        // The format has neither signs nor infinities; its largest value stands for what lies beyond it.
        const float largest = std::ldexp(255.0f, 255 - exponent_bias);
        value[c] = rgb[c] > 0.0f ? std::min(rgb[c], largest) : 0.0f;
    }
    const float highest = std::max({value[0], value[1], value[2]});
    int exponent = 0;
    std::frexp(highest, &exponent);
    if (highest <= 0.0f || exponent < -127) return {0, 0, 0, 0};
    // A mantissa that would round up to 256 needs the next exponent.
    if (std::lround(std::ldexp(highest, 8 - exponent)) > 255) ++exponent;
    Rgbe pixel{};
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(std::lround(std::ldexp(value[c], 8 - exponent)));
    pixel[3] = static_cast<std::uint8_t>(exponent + 128);
    return pixel;
}

}  // namespace

Result<Picture> decode_hdr(std::string_view bytes) {
    std::string_view rest = bytes;
    const Result<Header> header = read_header(rest);
    if (!header) return tl::unexpected(header.error());
    // A run covers at most 127 bytes of a channel in 2: 64 bytes a byte. Old repeats reach further but are rare.
    if (auto checked = check_size(header->width, header->height, 4, bytes.size(), 1024); !checked) {
        return tl::unexpected(checked.error());
    }
    Picture picture;
    picture.image = Image(header->width, header->height, 3);
    Scanlines scanlines(rest);
    std::vector<Rgbe> line(static_cast<std::size_t>(header->width));
    for (int row = 0; row < header->height; ++row) {
        const int y = header->bottom_up ? header->height - 1 - row : row;
        if (!scanlines.read(line))
            return fail("", fmt::format("truncated or damaged at row {} of {}", row, header->height));
        for (int x = 0; x < header->width; ++x) {
            const Rgbe& pixel = line[static_cast<std::size_t>(x)];
            const float scale = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f / header->exposure, pixel[3] - exponent_bias);
            for (int c = 0; c < 3; ++c) picture.image.at(x, y, c) = scale * static_cast<float>(pixel[c]);
        }
    }
    return picture;
}

Result<std::string> encode_hdr(const Image& image) {
    std::string bytes = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
    bytes.reserve(bytes.size() + static_cast<std::size_t>(image.width) * image.height * 4);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const glm::vec3 rgb = image.rgb(x, y);
            const Rgbe pixel = encode(&rgb.x);
            bytes.append(reinterpret_cast<const char*>(pixel.data()), pixel.size());
        }
    }
    return bytes;
}

}  // namespace heliodon::codecs
