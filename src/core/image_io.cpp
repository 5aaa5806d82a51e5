#include "core/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>

#include "core/picture_codecs.h"

namespace heliodon {

namespace {

struct Format {
    std::string_view ending;
    Result<Picture> (*decode)(std::string_view bytes);
    Result<std::string> (*encode)(const Picture& picture);
    bool display;
};

template <Result<std::string> (*encode)(const Image&)>
Result<std::string> encode_image_of(const Picture& picture) {
    return encode(picture.image);
}

constexpr std::array formats = {
    Format{".exr", codecs::decode_exr, codecs::encode_exr, false},
    Format{".hdr", codecs::decode_hdr, encode_image_of<codecs::encode_hdr>, false},
    Format{".pfm", codecs::decode_pfm, encode_image_of<codecs::encode_pfm>, false},
    Format{".png", codecs::decode_png, encode_image_of<codecs::encode_png>, true},
    Format{".jpg", codecs::decode_jpeg, encode_image_of<codecs::encode_jpeg>, true},
    Format{".jpeg", codecs::decode_jpeg, encode_image_of<codecs::encode_jpeg>, true},
};

/// The format that the path's ending names, or null.
const Format* format_of(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    const auto found =
        std::find_if(formats.begin(), formats.end(), [&](const Format& f) { return f.ending == ending; });
    return found == formats.end() ? nullptr : &*found;
}

tl::unexpected<Error> unknown_ending(const std::filesystem::path& path) {
    const std::string ending = path.extension().string();
    return fail(path.string(), fmt::format("expected a picture ending in .exr .hdr .pfm .png .jpg, found {}",
                                           ending.empty() ? "no ending" : '"' + ending + '"'));
}

/// A message on one line: what a library quotes from a damaged file may hold anything.
std::string printable(std::string message) {
    std::replace_if(
        message.begin(), message.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7f; }, '?');
    return message;
}

/// Runs a codec on behalf of `path`: its errors get the file's name, and what it throws becomes an error.
template <class Codec>
auto located(const std::filesystem::path& path, Codec&& codec) -> decltype(codec()) {
    try {
        return codec().map_error([&](Error error) {
            return Error{path.string(), printable(std::move(error.message))};
        });
    } catch (const std::bad_alloc&) {
        return fail(path.string(), "not enough memory for the picture");
    } catch (const std::exception& exception) {
        return fail(path.string(), printable(exception.what()));
    }
}

Result<void> check_consistent(const std::filesystem::path& path, const Image& image, const std::string& what) {
    const bool sized = image.width > 0 && image.height > 0 && image.width <= codecs::max_side &&
                       image.height <= codecs::max_side && image.channels >= 1 && image.channels <= 4;
    const auto expected = static_cast<std::size_t>(std::max(image.width, 0)) * std::max(image.height, 0) *
                          static_cast<std::size_t>(std::max(image.channels, 0));
    if (sized && image.pixels.size() == expected) return {};
    return fail(path.string(), fmt::format("{} of {}x{} pixels with {} channels and {} values cannot be written", what,
                                           image.width, image.height, image.channels, image.pixels.size()));
}

}  // namespace

namespace codecs {

Result<void> check_size(std::int64_t width, std::int64_t height, std::int64_t bytes_per_pixel, std::size_t file_bytes,
                        std::int64_t max_expansion) {
    if (width < 1 || height < 1 || width > max_side || height > max_side) {
        return fail("",
                    fmt::format("expected a size from 1x1 to {0}x{0} pixels, found {1}x{2}", max_side, width, height));
    }
    // The first 64 KiB are free: tiny pictures of one colour compress beyond any ratio.
    const auto limit = static_cast<double>(file_bytes) * static_cast<double>(max_expansion) + 65536.0;
    if (static_cast<double>(width) * static_cast<double>(height) * static_cast<double>(bytes_per_pixel) > limit) {
        return fail("", fmt::format("the header says {}x{} pixels, more than a file of {} bytes can hold", width,
                                    height, file_bytes));
    }
    return {};
}

}  // namespace codecs

bool is_display_format(const std::filesystem::path& path) {
    const Format* format = format_of(path);
    return format != nullptr && format->display;
}

Result<void> check_writable(const std::filesystem::path& path) {
    if (format_of(path) == nullptr) return unknown_ending(path);
    return check_directory_writable(path);
}

Result<Picture> decode_picture(const std::filesystem::path& name, std::string_view bytes) {
    const Format* format = format_of(name);
    if (format == nullptr) return unknown_ending(name);
    if (bytes.empty()) return fail(name.string(), "the file is empty");
    return located(name, [&] { return format->decode(bytes); });
}

Result<Picture> read_picture(const std::filesystem::path& path) {
    if (format_of(path) == nullptr) return unknown_ending(path);
    const Result<std::string> bytes = read_file(path);
    if (!bytes) return tl::unexpected(bytes.error());
    return decode_picture(path, *bytes);
}

Result<void> write_picture(const std::filesystem::path& path, const Picture& picture) {
    const Format* format = format_of(path);
    if (format == nullptr) return unknown_ending(path);
    if (auto checked = check_consistent(path, picture.image, "a picture"); !checked) return checked;
    for (const Layer& layer : picture.layers) {
        if (auto checked = check_consistent(path, layer.image, "layer " + layer.name); !checked) return checked;
    }
    const Result<std::string> bytes = located(path, [&] { return format->encode(picture); });
    if (!bytes) return tl::unexpected(bytes.error());
    return write_file_atomically(path, *bytes);
}

}  // namespace heliodon
