#include "import/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "core/image_io.h"

namespace heliodon::import::gltf {
namespace {

constexpr std::uint32_t glb_magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
/// Deeper nesting than any real file has; bounds the recursion of whoever walks the tree.
constexpr int deepest_json = 64;

std::uint32_t little_endian_32(const std::string& bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | std::uint8_t(bytes[offset + i]);
    return value;
}

/// The length in bytes that a run of elements spans; the last element needs no padding to the stride.
/// Empty where it overflows.
std::optional<std::size_t> span_of(std::size_t count, std::size_t stride, std::size_t element) {
    if (count == 0) return 0;
    std::size_t bytes = 0;
    if (__builtin_mul_overflow(count - 1, stride, &bytes) || __builtin_add_overflow(bytes, element, &bytes)) return {};
    return bytes;
}

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

}  // namespace

std::size_t size_of(ComponentType type) {
    switch (type) {
        case ComponentType::i8:
        case ComponentType::u8:
            return 1;
        case ComponentType::i16:
        case ComponentType::u16:
            return 2;
        default:
            return 4;
    }
}

Document::Document(const std::filesystem::path& path, Warnings& warnings) : path_(path) {
    Result<std::string> file = read_file(path);
    if (!file) throw ImportFailure(file.error());
    file_ = std::move(*file);
    split_container(warnings);
    validate(*this, warnings);
    load_buffers();
    load_views();
    load_accessors();
    load_data_pictures();
}

std::string Document::where(std::string_view json_path) const {
    return fmt::format("{}: {}", path_.string(), json_path);
}

void Document::refuse(std::string_view json_path, std::string message) const {
    import::refuse(where(json_path), std::move(message));
}

std::size_t Document::count(const char* array) const {
    const auto at = json_.find(array);
    return at == json_.end() ? 0 : at->size();
}

void Document::split_container(Warnings& warnings) {
    const auto complain = [&](const std::string& message) { import::refuse(path_.string(), message); };
    if (file_.size() < 4 || little_endian_32(file_, 0) != glb_magic) {
        if (path_.extension() == ".glb") complain("expected a binary glTF, found no \"glTF\" at its start");
        parse_json(file_, 0);
        return;
    }
    if (file_.size() < 20)
        complain(fmt::format("binary glTF is cut off: {} bytes, its header alone has 20", file_.size()));
    if (const std::uint32_t version = little_endian_32(file_, 4); version != 2)
        complain(fmt::format("expected binary glTF version 2, found {}", version));
    const std::size_t length = little_endian_32(file_, 8);
    if (length > file_.size())
        complain(
            fmt::format("binary glTF is cut off: its header says {} bytes, the file has {}", length, file_.size()));
    if (length < file_.size())
        warnings.push_back(
            {path_.string(), fmt::format("ignores {} bytes behind the end of the binary glTF", file_.size() - length)});
    std::size_t offset = 12;
    bool has_json = false;
    while (length - offset >= 8) {
        const std::size_t bytes = little_endian_32(file_, offset);
        const std::uint32_t type = little_endian_32(file_, offset + 4);
        offset += 8;
        if (bytes > length - offset)
            complain(fmt::format("chunk at byte {} says {} bytes, {} are left", offset - 8, bytes, length - offset));
        if (!has_json) {
            if (type != json_chunk) complain("expected the first chunk to be JSON");
            parse_json(std::string_view(file_).substr(offset, bytes), offset);
            has_json = true;
        } else if (type == binary_chunk && !has_binary_chunk_) {
            binary_chunk_ = {reinterpret_cast<const std::uint8_t*>(file_.data()) + offset, bytes};
            has_binary_chunk_ = true;
        }
        offset += bytes;
    }
    if (!has_json) complain("expected a JSON chunk, found none");
}

void Document::parse_json(std::string_view text, std::size_t offset) {
    const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
        if (depth > deepest_json)
            import::refuse(path_.string(), fmt::format("JSON nests deeper than {} levels", deepest_json));
        return true;
    };
    try {
        json_ = Json::parse(text.begin(), text.end(), limit_depth);
    } catch (const Json::parse_error& error) {
        // nlohmann's own text begins with its error number and place; what follows is for people.
        std::string message = error.what();
        if (const std::size_t at = message.find(": "); at != std::string::npos) message.erase(0, at + 2);
        const std::size_t byte = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
        const std::string_view before = text.substr(0, byte);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const std::size_t column =
            byte - (before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1) + 1;
        if (offset > 0)
            import::refuse(path_.string(), fmt::format("JSON chunk is damaged at byte {}: {}", offset + byte, message));
        import::refuse(fmt::format("{}:{}:{}", path_.string(), line, column), message);
    } catch (const Json::exception& error) {
        import::refuse(path_.string(), error.what());
    }
    if (!json_.is_object()) refuse("$", "expected an object");
}

std::filesystem::path Document::resolve(std::string_view uri) const {
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const auto digit = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) && digit(uri[i + 2])) {
            decoded += char(std::stoi(std::string(uri.substr(i + 1, 2)), nullptr, 16));
            i += 2;
        } else {
            decoded += uri[i];
        }
    }
    return (path_.parent_path() / std::filesystem::path(decoded)).lexically_normal();
}

std::vector<std::uint8_t> Document::decode_data_uri(std::string_view uri, std::string_view json_path) const {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        refuse(json_path, "expected a data URI in base64");
    std::string_view text = uri.substr(comma + 1);
    while (text.ends_with('=')) text.remove_suffix(1);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int digit = base64_digit(c);
        if (digit < 0) refuse(json_path, "data URI holds a character that is not base64");
        bits = bits << 6 | std::uint32_t(digit);
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes.push_back(std::uint8_t(bits >> held));
        }
    }
    return bytes;
}

void Document::load_buffers() {
    const std::size_t buffer_count = count("buffers");
    external_buffers_.reserve(buffer_count);
    decoded_.reserve(buffer_count + count("bufferViews") + count("images"));
    for (std::size_t i = 0; i < buffer_count; ++i) {
        const Json& buffer = json_["buffers"][i];
        const std::string at = fmt::format("$.buffers[{}]", i);
        const std::size_t length = unsigned_member(*this, buffer, "byteLength", {}, at);
        Bytes bytes;
        const Json* meshopt = extension(buffer, "EXT_meshopt_compression");
        if (buffer.contains("uri")) {
            const std::string& uri = buffer["uri"].get_ref<const std::string&>();
            if (uri.starts_with("data:")) {
                decoded_.push_back(decode_data_uri(uri, at + ".uri"));
                bytes = decoded_.back();
            } else {
                Result<std::string> file = read_file(resolve(uri));
                if (!file) refuse(at + ".uri", file.error().text());
                external_buffers_.push_back(std::move(*file));
                const std::string& kept = external_buffers_.back();
                bytes = {reinterpret_cast<const std::uint8_t*>(kept.data()), kept.size()};
            }
        } else if (i == 0 && has_binary_chunk_) {
            bytes = binary_chunk_;
        } else if (meshopt) {
            buffers_.emplace_back();  // a fallback buffer: only compressed views refer to it
            continue;
        } else {
            refuse(at, "expected a uri or a binary chunk, found neither");
        }
        if (bytes.size() < length)
            refuse(at + ".byteLength", fmt::format("says {} bytes, {} are there", length, bytes.size()));
        buffers_.push_back(bytes.first(length));
    }
}

Bytes Document::slice(Bytes bytes, const Json& object, std::string_view json_path) const {
    const std::size_t offset = unsigned_member(*this, object, "byteOffset", 0, json_path);
    const std::size_t length = unsigned_member(*this, object, "byteLength", {}, json_path);
    if (offset > bytes.size() || length > bytes.size() - offset)
        refuse(json_path, fmt::format("bytes {} to {} + {} lie outside its buffer of {} bytes", offset, offset, length,
                                      bytes.size()));
    return bytes.subspan(offset, length);
}

void Document::load_views() {
    for (std::size_t i = 0; i < count("bufferViews"); ++i) {
        const Json& view = json_["bufferViews"][i];
        const std::string at = fmt::format("$.bufferViews[{}]", i);
        const std::size_t stride = unsigned_member(*this, view, "byteStride", 0, at);
        if (stride > 252) refuse(at + ".byteStride", fmt::format("expected at most 252, found {}", stride));
        if (const Json* meshopt = extension(view, "EXT_meshopt_compression")) {
            const std::string inside = at + ".extensions.EXT_meshopt_compression";
            const std::size_t buffer = *index_member(*this, *meshopt, "buffer", "buffers", inside);
            decoded_.push_back(decode_meshopt(*this, *meshopt, slice(buffers_[buffer], *meshopt, inside), inside));
            views_.push_back({decoded_.back(), stride});
        } else {
            const std::size_t buffer = *index_member(*this, view, "buffer", "buffers", at);
            views_.push_back({slice(buffers_[buffer], view, at), stride});
        }
    }
}

void Document::load_accessors() {
    static constexpr std::array<std::pair<std::string_view, int>, 7> types{
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
    for (std::size_t i = 0; i < count("accessors"); ++i) {
        const Json& json = json_["accessors"][i];
        const std::string at = fmt::format("$.accessors[{}]", i);
        const auto component = [&](const Json& object, const std::string& path) {
            const std::size_t type = unsigned_member(*this, object, "componentType", {}, path);
            if (type < 5120 || type > 5126 || type == 5124)
                refuse(path + ".componentType", fmt::format("expected 5120 to 5123, 5125 or 5126, found {}", type));
            return ComponentType(type);
        };
        const auto fits = [&](Bytes bytes, std::size_t offset, std::size_t count, std::size_t stride,
                              std::size_t element, const std::string& path) {
            const std::optional<std::size_t> span = span_of(count, stride, element);
            if (!span || offset > bytes.size() || *span > bytes.size() - offset)
                refuse(path, fmt::format("{} elements of {} bytes from byte {} do not fit its buffer view of {} bytes",
                                         count, element, offset, bytes.size()));
            return bytes.subspan(offset, *span);
        };
        Accessor accessor;
        accessor.count = unsigned_member(*this, json, "count", {}, at);
        // 2^31 vertices are past what 32-bit indices and any memory here hold; it keeps products far from overflow.
        if (accessor.count == 0 || accessor.count > (std::size_t(1) << 31))
            refuse(at + ".count", fmt::format("expected 1 to 2^31 elements, found {}", accessor.count));
        accessor.type = component(json, at);
        const auto type =
            std::find_if(types.begin(), types.end(), [&](const auto& t) { return json.value("type", "") == t.first; });
        if (type == types.end()) refuse(at + ".type", "expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
        accessor.components = type->second;
        accessor.normalized = json.value("normalized", false);
        const std::size_t element = size_of(accessor.type) * std::size_t(accessor.components);
        if (const auto view = index_member(*this, json, "bufferView", "bufferViews", at)) {
            accessor.has_values = true;
            accessor.stride = views_[*view].stride ? views_[*view].stride : element;
            if (accessor.stride < element)
                refuse(at, fmt::format("elements of {} bytes overlap at its buffer view's stride of {}", element,
                                       accessor.stride));
            accessor.bytes = fits(views_[*view].bytes, unsigned_member(*this, json, "byteOffset", 0, at),
                                  accessor.count, accessor.stride, element, at);
        }
        if (json.contains("sparse")) {
            const Json& sparse = json["sparse"];
            Accessor::Sparse result;
            result.count = unsigned_member(*this, sparse, "count", {}, at + ".sparse");
            if (result.count > accessor.count) refuse(at + ".sparse.count", "exceeds the accessor's count");
            result.index_type = component(sparse["indices"], at + ".sparse.indices");
            const auto run = [&](const char* key, std::size_t size) {
                const std::string path = at + ".sparse." + key;
                const auto view = index_member(*this, sparse[key], "bufferView", "bufferViews", path);
                if (!view) refuse(path, "expected a bufferView");
                return fits(views_[*view].bytes, unsigned_member(*this, sparse[key], "byteOffset", 0, path),
                            result.count, size, size, path);
            };
            result.indices = run("indices", size_of(result.index_type));
            result.values = run("values", element);
            accessor.sparse = result;
        }
        accessors_.push_back(accessor);
    }
}

void Document::load_data_pictures() {
    for (std::size_t i = 0; i < count("images"); ++i) {
        const Json& image = json_["images"][i];
        const std::string at = fmt::format("$.images[{}]", i);
        Picture picture;
        if (const auto view = index_member(*this, image, "bufferView", "bufferViews", at)) {
            picture.bytes = views_[*view].bytes;
        } else {
            const std::string& uri = image["uri"].get_ref<const std::string&>();
            if (uri.starts_with("data:")) {
                decoded_.push_back(decode_data_uri(uri, at + ".uri"));
                picture.bytes = decoded_.back();
            } else {
                picture.file = resolve(uri);
            }
        }
        pictures_.push_back(picture);
    }
}

Document::Picture Document::picture(std::size_t image) const {
    return pictures_[image];
}

void Document::release_bytes() {
    for (std::string* text : {&file_}) std::string().swap(*text);
    external_buffers_ = {};
    decoded_ = {};
    buffers_ = {};
    views_ = {};
    accessors_ = {};
    pictures_ = {};
    binary_chunk_ = {};
}

}  // namespace heliodon::import::gltf
