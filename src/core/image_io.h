#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/image.h"
#include "core/result.h"

namespace heliodon {

/// Reads .exr (with its layers and `ev100` attribute), .hdr, .pfm, .png, .jpg. PNG and JPEG are decoded
/// from sRGB to linear. An EXR's picture is its R G B (A) or Y, else its first layer; of several parts the
/// first is read, over its data window. Errors name the file and what is wrong with it.
[[nodiscard]] Result<Picture> read_picture(const std::filesystem::path& path);
/// The same from a file's bytes; `name` gives the ending and stands in messages.
[[nodiscard]] Result<Picture> decode_picture(const std::filesystem::path& name, std::string_view bytes);

/// Whether a PNG's or JPEG's bytes are whole and safe to hand to stb, which forgives missing bytes and wrong
/// checksums and trusts the sizes of Huffman tables. Bytes of any other format pass. Leaves `where` empty.
[[nodiscard]] Result<void> check_display_picture(std::string_view bytes);

/// Writes by ending: .exr (float, absolute values, `whiteLuminance` = 1, `ev100`, layers), .hdr, .pfm
/// (linear), .png, .jpg (values already tone-mapped and *display-encoded* to [0,1]: units::srgb_encode).
/// A layer's channels are named R G B (A), X Y Z where its name is `normal` or `position`, Z for a single
/// channel named `depth`, Y for any other.
/// The file appears whole or not at all.
[[nodiscard]] Result<void> write_picture(const std::filesystem::path& path, const Picture& picture);

/// True for endings that hold display-encoded 8-bit pictures (.png .jpg .jpeg).
[[nodiscard]] bool is_display_format(const std::filesystem::path& path);
/// Checks before any work is done that `path` has a known ending and lies in a writable directory.
[[nodiscard]] Result<void> check_writable(const std::filesystem::path& path);
/// The same for a file of any ending.
[[nodiscard]] Result<void> check_directory_writable(const std::filesystem::path& path);

/// Writes `bytes` to a temporary name beside `path` and renames it; a link stays a link to what it names, and
/// devices and pipes are written to directly.
[[nodiscard]] Result<void> write_file_atomically(const std::filesystem::path& path, std::string_view bytes);
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace heliodon
