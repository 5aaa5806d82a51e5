#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "convert/flat_scene.h"

namespace heliodon::trace {

/// Reads texels of the scene's own textures for the kernel: one level (a path tracer's many samples filter
/// what mip levels would), bilinear or nearest.
class TextureTable {
public:
    void update(const convert::FlatScene& flat);

    /// Linear RGBA; v runs down from the picture's top. White where there is no such texture.
    [[nodiscard]] glm::vec4 sample(std::uint32_t index, glm::vec2 uv) const {
        if (index >= entries_.size() || !entries_[index].texels) return glm::vec4(1);
        const Entry& entry = entries_[index];
        if (!(std::abs(uv.x) < 1e9f && std::abs(uv.y) < 1e9f)) return texel(entry, 0);
        const float x = along(uv.x, entry.width, entry.wrap_u), y = along(uv.y, entry.height, entry.wrap_v);
        const auto row = [&](int i) { return static_cast<std::size_t>(wrapped(i, entry.height, entry.wrap_v)) * entry.width; };
        const auto column = [&](int i) { return wrapped(i, entry.width, entry.wrap_u); };
        if (entry.nearest) return texel(entry, row(floor_to_int(y)) + column(floor_to_int(x)));
        const int x0 = floor_to_int(x - 0.5f), y0 = floor_to_int(y - 0.5f);
        const float fx = x - 0.5f - static_cast<float>(x0), fy = y - 0.5f - static_cast<float>(y0);
        const std::size_t top = row(y0), bottom = row(y0 + 1);
        const int left = column(x0), right = column(x0 + 1);
        return glm::mix(glm::mix(texel(entry, top + left), texel(entry, top + right), fx),
                        glm::mix(texel(entry, bottom + left), texel(entry, bottom + right), fx), fy);
    }
    /// Texels across and down at the level that `sample` reads; 1 × 1 where there is no such texture.
    [[nodiscard]] glm::ivec2 size(std::uint32_t index) const {
        if (index >= entries_.size() || !entries_[index].texels) return glm::ivec2(1);
        return {entries_[index].width, entries_[index].height};
    }
    struct Entry {
        const std::uint8_t* texels = nullptr;
        int width = 1, height = 1;
        TextureFormat format = TextureFormat::srgb8;
        Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
        bool nearest = false;
    };
    /// The table for readers of their own (lanes/fetch.h): `count` entries and a white one behind them, which also stands
    /// in for those without texels; what bytes of sRGB mean.
    struct Contents {
        const Entry* entries;
        std::uint32_t count;
        const float* srgb;
    };
    [[nodiscard]] Contents contents() const { return {whole_.data(), static_cast<std::uint32_t>(entries_.size()), srgb_.data()}; }

private:

    [[nodiscard]] static int floor_to_int(float x) {
        const int towards_zero = static_cast<int>(x);
        return towards_zero - (x < static_cast<float>(towards_zero) ? 1 : 0);
    }
    /// A place on one axis in texels, brought to the first period: what is left for `wrapped` needs no division.
    [[nodiscard]] static float along(float u, int size, Wrap wrap) {
        if (wrap == Wrap::repeat) u -= static_cast<float>(floor_to_int(u));
        if (wrap == Wrap::mirrored_repeat) u -= 2.0f * static_cast<float>(floor_to_int(0.5f * u));
        if (wrap == Wrap::clamp_to_edge) u = std::clamp(u, 0.0f, 1.0f);
        return u * static_cast<float>(size);
    }
    /// `i` at most one texel outside of the period.
    [[nodiscard]] static int wrapped(int i, int size, Wrap wrap) {
        if (i >= 0 && i < size) return i;
        if (wrap == Wrap::clamp_to_edge) return i < 0 ? 0 : size - 1;
        if (wrap == Wrap::repeat) return i < 0 ? size - 1 : 0;
        return i < 0 || i >= 2 * size ? 0 : 2 * size - 1 - i;
    }
    [[nodiscard]] glm::vec4 texel(const Entry& entry, std::size_t index) const {
        if (entry.format == TextureFormat::float32) {
            glm::vec4 value;
            std::memcpy(&value, entry.texels + 16 * index, 16);
            return value;
        }
        const std::uint8_t* bytes = entry.texels + 4 * index;
        const std::array<float, 256>& decode = entry.format == TextureFormat::srgb8 ? srgb_ : linear_;
        return {decode[bytes[0]], decode[bytes[1]], decode[bytes[2]], linear_[bytes[3]]};
    }

    std::vector<Entry> entries_;
    std::vector<Entry> whole_;  ///< Contents::entries
    std::array<float, 256> srgb_{}, linear_{};
};

}  // namespace heliodon::trace
