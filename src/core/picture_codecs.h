#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/image.h"
#include "core/result.h"

/// One decoder and encoder a file format, from bytes to bytes. Their errors leave `where` empty; whoever
/// knows the file's name fills it in.
namespace heliodon::codecs {

/// Longest side that any reader or writer accepts: what a damaged header says beyond it is no picture.
inline constexpr int max_side = 65536;

/// Refuses empty and absurd sizes, and pictures that `file_bytes` cannot hold even if each byte of the file
/// stood for `max_expansion` bytes of pixels, before anything of that size is allocated.
[[nodiscard]] Result<void> check_size(std::int64_t width, std::int64_t height, std::int64_t bytes_per_pixel,
                                      std::size_t file_bytes, std::int64_t max_expansion);

[[nodiscard]] Result<Picture> decode_exr(std::string_view bytes);
[[nodiscard]] Result<std::string> encode_exr(const Picture& picture);

/// Radiance's RGBE pictures.
[[nodiscard]] Result<Picture> decode_hdr(std::string_view bytes);
[[nodiscard]] Result<std::string> encode_hdr(const Image& image);

/// Portable float maps.
[[nodiscard]] Result<Picture> decode_pfm(std::string_view bytes);
[[nodiscard]] Result<std::string> encode_pfm(const Image& image);

/// Walks a PNG's chunks and checks their checksums; gives the bytes that a pixel takes before compression,
/// at least 1 (PNG specification, section 11.2.1).
[[nodiscard]] Result<int> check_png(std::string_view bytes);
/// Walks a JPEG's segments; asks for an end marker and for Huffman tables of lawful size (ITU-T T.81, annex B).
[[nodiscard]] Result<void> check_jpeg(std::string_view bytes);

/// 8- and 16-bit pictures, decoded from sRGB to linear; encoded from display values as they are.
[[nodiscard]] Result<Picture> decode_png(std::string_view bytes);
[[nodiscard]] Result<Picture> decode_jpeg(std::string_view bytes);
[[nodiscard]] Result<std::string> encode_png(const Image& image);
[[nodiscard]] Result<std::string> encode_jpeg(const Image& image);

}  // namespace heliodon::codecs
