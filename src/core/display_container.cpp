#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/image_io.h"
#include "core/picture_codecs.h"

namespace heliodon {
namespace {

constexpr std::string_view png_signature("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view jpeg_start("\xff\xd8\xff", 3);

std::uint32_t byte(std::string_view bytes, std::size_t at) {
    return static_cast<std::uint8_t>(bytes[at]);
}

std::uint32_t big_endian_16(std::string_view bytes, std::size_t at) {
    return byte(bytes, at) << 8 | byte(bytes, at + 1);
}

std::uint32_t big_endian_32(std::string_view bytes, std::size_t at) {
    return big_endian_16(bytes, at) << 16 | big_endian_16(bytes, at + 2);
}

/// CRC-32 of ISO 3309 (PNG specification, annex D), reflected polynomial 0xedb88320.
std::uint32_t crc32(std::string_view bytes) {
    static const auto table = [] {
        std::array<std::uint32_t, 256> entries{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            entries[i] = i;
            for (int bit = 0; bit < 8; ++bit) entries[i] = entries[i] >> 1 ^ (entries[i] & 1 ? 0xedb88320u : 0u);
        }
        return entries;
    }();
    std::uint32_t crc = 0xffffffffu;
    for (const char c : bytes) crc = crc >> 8 ^ table[(crc ^ static_cast<std::uint8_t>(c)) & 0xffu];
    return ~crc;
}

tl::unexpected<Error> truncated_jpeg(std::string_view bytes) {
    return fail("", fmt::format("truncated JPEG at byte {}", bytes.size()));
}

/// The tables of the DHT segment whose length stands at `at`: sixteen counts and as many values as they add
/// up to, at most 256 (T.81, B.2.4.2).
Result<void> check_huffman_tables(std::string_view bytes, std::size_t at) {
    const auto damaged = [at] { return fail("", fmt::format("damaged JPEG: unlawful Huffman table at byte {}", at)); };
    if (bytes.size() < at + 2) return truncated_jpeg(bytes);
    const std::size_t end = at + big_endian_16(bytes, at);
    if (end > bytes.size()) return truncated_jpeg(bytes);
    for (at += 2; at < end;) {
        constexpr std::size_t head = 17;
        if (end - at < head) return damaged();
        std::size_t values = 0;
        for (std::size_t i = 1; i < head; ++i) values += byte(bytes, at + i);
        if (values > 256 || values > end - at - head) return damaged();
        at += head + values;
    }
    return {};
}

}  // namespace

namespace codecs {

Result<int> check_png(std::string_view bytes) {
    if (!bytes.starts_with(png_signature)) return fail("", "expected a PNG picture");
    int bytes_per_pixel = 0;
    for (std::size_t at = png_signature.size();;) {
        if (bytes.size() - at < 12) return fail("", fmt::format("truncated PNG at byte {}", bytes.size()));
        const std::size_t length = big_endian_32(bytes, at);
        const std::string_view type = bytes.substr(at + 4, 4);
        if (length > bytes.size() - at - 12) return fail("", fmt::format("truncated or damaged PNG at byte {}", at));
        if (crc32(bytes.substr(at + 4, 4 + length)) != big_endian_32(bytes, at + 8 + length)) {
            return fail("", fmt::format("damaged PNG: wrong checksum at byte {}", at));
        }
        if (type == "IHDR" && length >= 10) {
            const std::uint32_t depth = byte(bytes, at + 16), colour = byte(bytes, at + 17);
            const std::uint32_t channels = (colour & 1) ? 1 : 1 + (colour & 2) + (colour >> 2 & 1);
            bytes_per_pixel = static_cast<int>(std::max(1u, depth * channels / 8));
        }
        if (type == "IEND") break;
        at += 12 + length;
    }
    if (bytes_per_pixel == 0) return fail("", "damaged PNG: no header");
    return bytes_per_pixel;
}

Result<void> check_jpeg(std::string_view bytes) {
    if (!bytes.starts_with(jpeg_start)) return fail("", "expected a JPEG picture");
    constexpr std::uint32_t start_of_scan = 0xda, huffman_tables = 0xc4;
    std::size_t at = 2;
    for (;;) {
        // Padding before a marker and fill bytes within it are common and lawful enough.
        while (at < bytes.size() && byte(bytes, at) != 0xff) ++at;
        while (at < bytes.size() && byte(bytes, at) == 0xff) ++at;
        if (bytes.size() < at + 3) return truncated_jpeg(bytes);
        const std::uint32_t marker = byte(bytes, at);
        if (marker == huffman_tables) {
            if (auto checked = check_huffman_tables(bytes, at + 1); !checked) return checked;
        }
        if (marker == start_of_scan) break;
        at += 1 + std::max(2u, big_endian_16(bytes, at + 1));
    }
    // Coded data hold no marker by accident (each 0xff is followed by 0), so that these are found by looking.
    if (bytes.find("\xff\xd9", at) == std::string_view::npos) return truncated_jpeg(bytes);
    for (std::size_t found = at; (found = bytes.find("\xff\xc4", found)) != std::string_view::npos; found += 2) {
        if (auto checked = check_huffman_tables(bytes, found + 2); !checked) return checked;
    }
    return {};
}

}  // namespace codecs

Result<void> check_display_picture(std::string_view bytes) {
    if (bytes.starts_with(jpeg_start)) return codecs::check_jpeg(bytes);
    if (!bytes.starts_with(png_signature)) return {};
    return codecs::check_png(bytes).map([](int) {});
}

}  // namespace heliodon
