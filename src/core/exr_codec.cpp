// OpenEXR pictures with layers, from and to memory, so that the files themselves are read and written in
// one place.
#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/picture_codecs.h"

namespace heliodon::codecs {
namespace {

constexpr const char* ev100_attribute = "ev100";
constexpr std::string_view own_attributes = "heliodon.";  // what the names of Picture::attributes begin with there

class MemoryInput : public Imf::IStream {
public:
    explicit MemoryInput(std::string_view bytes) : Imf::IStream("picture"), bytes_(bytes) {}

    bool read(char target[], int count) override {
        if (count < 0 || position_ > bytes_.size() || bytes_.size() - position_ < static_cast<std::size_t>(count)) {
            throw std::runtime_error(fmt::format("truncated EXR at byte {}", bytes_.size()));
        }
        std::memcpy(target, bytes_.data() + position_, static_cast<std::size_t>(count));
        position_ += static_cast<std::size_t>(count);
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

private:
    std::string_view bytes_;
    uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
public:
    MemoryOutput() : Imf::OStream("picture") {}

    void write(const char source[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (bytes_.size() < position_ + size) bytes_.resize(position_ + size);
        std::memcpy(bytes_.data() + position_, source, size);
        position_ += size;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    uint64_t position_ = 0;
};

// ---- writing

/// The channels' names of a layer: full names in file order.
std::vector<std::string> channel_names(const std::string& layer, int channels) {
    const bool is_vector = layer == "normal" || layer == "position";
    const std::string_view components = channels == 1   ? (layer == "depth" ? "Z" : "Y")
                                        : channels == 2 ? "XY"
                                        : is_vector     ? "XYZA"
                                                        : "RGBA";
    std::vector<std::string> names;
    for (int c = 0; c < channels; ++c) names.push_back((layer.empty() ? "" : layer + ".") + components[c]);
    return names;
}

Result<void> add_channels(Imf::Header& header, Imf::FrameBuffer& buffer, const std::string& layer, const Image& image) {
    if (image.width != header.dataWindow().max.x + 1 || image.height != header.dataWindow().max.y + 1) {
        return fail("", fmt::format("layer {} has {}x{} pixels, the picture {}x{}", layer, image.width, image.height,
                                    header.dataWindow().max.x + 1, header.dataWindow().max.y + 1));
    }
    const std::vector<std::string> names = channel_names(layer, image.channels);
    for (std::size_t c = 0; c < names.size(); ++c) {
        if (header.channels().findChannel(names[c]) != nullptr) {
            return fail("", fmt::format("two layers have a channel {}", names[c]));
        }
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        // OpenEXR's slices take mutable memory for reading and writing alike; writing only reads it.
        char* base = reinterpret_cast<char*>(const_cast<float*>(image.pixels.data() + c));
        const std::size_t pixel_bytes = sizeof(float) * static_cast<std::size_t>(image.channels);
        buffer.insert(names[c],
                      Imf::Slice(Imf::FLOAT, base, pixel_bytes, pixel_bytes * static_cast<std::size_t>(image.width)));
    }
    return {};
}

// ---- reading

/// One picture of the file: which channels make it up.
struct Selection {
    std::string layer;
    std::vector<std::string> channels;  ///< full names
    bool colour = false;
};

std::pair<std::string, std::string> split_name(const std::string& channel) {
    const std::size_t dot = channel.rfind('.');
    if (dot == std::string::npos) return {"", channel};
    return {channel.substr(0, dot), channel.substr(dot + 1)};
}

/// Groups the file's channels into pictures: RGB(A), XYZ and XY belong together, all else stands alone.
std::vector<Selection> group_channels(const Imf::ChannelList& list) {
    std::map<std::string, std::set<std::string>> components_of;
    for (auto channel = list.begin(); channel != list.end(); ++channel) {
        const auto [layer, component] = split_name(channel.name());
        components_of[layer].insert(component);
    }
    std::vector<Selection> selections;
    for (auto& entry : components_of) {
        const std::string& layer = entry.first;
        std::set<std::string>& components = entry.second;
        const std::string prefix = layer.empty() ? "" : layer + ".";
        const bool alone = components.size() == 1;
        for (const std::string_view pattern : {"RGBA", "RGB", "XYZA", "XYZ", "XY"}) {
            const auto has = [&](char c) { return components.contains(std::string(1, c)); };
            if (!std::all_of(pattern.begin(), pattern.end(), has)) continue;
            Selection selection{layer, {}, pattern[0] == 'R'};
            for (const char c : pattern) {
                selection.channels.push_back(prefix + c);
                components.erase(std::string(1, c));
            }
            selections.push_back(std::move(selection));
        }
        for (const std::string& component : components) {
            selections.push_back({alone && !layer.empty() ? layer : prefix + component, {prefix + component}, false});
        }
    }
    return selections;
}

/// The selection that is the picture itself; the others are its layers.
std::size_t main_selection(const std::vector<Selection>& selections) {
    const auto find = [&](auto&& condition) { return std::find_if(selections.begin(), selections.end(), condition); };
    auto found = find([](const Selection& s) { return s.layer.empty() && s.colour; });
    if (found == selections.end())
        found = find([](const Selection& s) { return s.channels == std::vector<std::string>{"Y"}; });
    if (found == selections.end()) found = find([](const Selection& s) { return s.colour; });
    return found == selections.end() ? 0 : static_cast<std::size_t>(found - selections.begin());
}

void insert_slices(Imf::FrameBuffer& buffer, const Selection& selection, Image& image, const Imath::Box2i& window) {
    for (std::size_t c = 0; c < selection.channels.size(); ++c) {
        buffer.insert(
            selection.channels[c],
            Imf::Slice::Make(Imf::FLOAT, image.pixels.data() + c, window, sizeof(float) * selection.channels.size(),
                             sizeof(float) * selection.channels.size() * static_cast<std::size_t>(image.width)));
    }
}

/// Decodes rows first_y..last_y of the data window into one image a selection.
std::vector<Image> read_rows(Imf::InputFile& file, const std::vector<Selection>& selections, int first_y, int last_y) {
    Imath::Box2i window = file.header().dataWindow();
    window.min.y = first_y;
    window.max.y = last_y;
    std::vector<Image> images;
    images.reserve(selections.size());
    Imf::FrameBuffer buffer;
    for (const Selection& selection : selections) {
        images.emplace_back(window.max.x - window.min.x + 1, last_y - first_y + 1,
                            static_cast<int>(selection.channels.size()));
        insert_slices(buffer, selection, images.back(), window);
    }
    file.setFrameBuffer(buffer);
    file.readPixels(first_y, last_y);
    return images;
}

Result<void> check_header(const Imf::Header& header, std::size_t file_bytes) {
    const Imath::Box2i& window = header.dataWindow();
    std::int64_t channels = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel, ++channels) {
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
            return fail("", fmt::format("channel {} is subsampled, which is not supported", channel.name()));
        }
    }
    if (channels == 0) return fail("", "the EXR has no channels");
    // Coarser than any of OpenEXR's compressors reaches on pictures; what passes is probed row by row.
    constexpr std::int64_t max_expansion = 16384;
    return check_size(std::int64_t{window.max.x} - window.min.x + 1, std::int64_t{window.max.y} - window.min.y + 1,
                      channels * 4, file_bytes, max_expansion);
}

/// OpenEXR's own guard against absurd headers, before it allocates its tables; set once for the process.
void limit_openexr() {
    static const bool limited = [] {
        Imf::Header::setMaxImageSize(max_side, max_side);
        Imf::Header::setMaxTileSize(max_side, max_side);
        return true;
    }();
    static_cast<void>(limited);
}

}  // namespace

Result<Picture> decode_exr(std::string_view bytes) {
    if (!bytes.starts_with("\x76\x2f\x31\x01")) return fail("", "expected an OpenEXR picture");
    limit_openexr();
    MemoryInput stream(bytes);
    Imf::InputFile file(stream, 0);
    const Imf::Header& header = file.header();
    if (auto checked = check_header(header, bytes.size()); !checked) return tl::unexpected(checked.error());
    if (!file.isComplete()) return fail("", "truncated EXR: rows are missing");
    const std::vector<Selection> selections = group_channels(header.channels());
    const Imath::Box2i window = header.dataWindow();
    // A damaged size shows at the first or the last row, before the whole picture is allocated.
    for (const int y : {window.min.y, window.max.y}) read_rows(file, selections, y, y);

    std::vector<Image> images = read_rows(file, selections, window.min.y, window.max.y);
    Picture picture;
    const std::size_t main = main_selection(selections);
    picture.image = std::move(images[main]);
    for (std::size_t i = 0; i < selections.size(); ++i) {
        if (i != main) picture.layers.push_back({selections[i].layer, std::move(images[i])});
    }
    if (const auto* ev100 = header.findTypedAttribute<Imf::FloatAttribute>(ev100_attribute);
        ev100 != nullptr && std::isfinite(ev100->value())) {
        picture.ev100 = ev100->value();
        picture.has_ev100 = true;
    }
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
        const std::string_view name = attribute.name();
        if (text != nullptr && name.starts_with(own_attributes))
            picture.attributes[std::string(name.substr(own_attributes.size()))] = text->value();
    }
    return picture;
}

Result<std::string> encode_exr(const Picture& picture) {
    Imf::Header header(picture.image.width, picture.image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addWhiteLuminance(header, 1.0f);  // values are cd/m²
    if (picture.has_ev100) header.insert(ev100_attribute, Imf::FloatAttribute(picture.ev100));
    for (const auto& [name, text] : picture.attributes)
        header.insert(std::string(own_attributes) + name, Imf::StringAttribute(text));
    Imf::FrameBuffer buffer;
    if (auto added = add_channels(header, buffer, "", picture.image); !added) return tl::unexpected(added.error());
    for (const Layer& layer : picture.layers) {
        if (layer.name.empty()) return fail("", "a layer has no name");
        if (auto added = add_channels(header, buffer, layer.name, layer.image); !added)
            return tl::unexpected(added.error());
    }
    MemoryOutput stream;
    {
        Imf::OutputFile file(stream, header, 0);
        file.setFrameBuffer(buffer);
        file.writePixels(picture.image.height);
    }  // the line offsets are written when the file closes
    return stream.take();
}

}  // namespace heliodon::codecs
