#pragma once

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
        const float x = uv.x * static_cast<float>(entry.width), y = uv.y * static_cast<float>(entry.height);
        if (!(std::abs(x) < 1e9f && std::abs(y) < 1e9f)) return texel(entry, 0, 0);
        if (entry.nearest) return texel(entry, floor_to_int(x), floor_to_int(y));
        const int x0 = floor_to_int(x - 0.5f), y0 = floor_to_int(y - 0.5f);
        const float fx = x - 0.5f - static_cast<float>(x0), fy = y - 0.5f - static_cast<float>(y0);
        const glm::vec4 top = glm::mix(texel(entry, x0, y0), texel(entry, x0 + 1, y0), fx);
        const glm::vec4 bottom = glm::mix(texel(entry, x0, y0 + 1), texel(entry, x0 + 1, y0 + 1), fx);
        return glm::mix(top, bottom, fy);
    }
    /// Texels across and down at the level that `sample` reads; 1 × 1 where there is no such texture.
    [[nodiscard]] glm::ivec2 size(std::uint32_t index) const {
        if (index >= entries_.size() || !entries_[index].texels) return glm::ivec2(1);
        return {entries_[index].width, entries_[index].height};
    }

private:
    struct Entry {
        const std::uint8_t* texels = nullptr;
        int width = 1, height = 1;
        TextureFormat format = TextureFormat::srgb8;
        Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
        bool nearest = false;
    };

    [[nodiscard]] static int floor_to_int(float x) { return static_cast<int>(std::floor(x)); }
    [[nodiscard]] static int wrapped(int i, int size, Wrap wrap) {
        if (i >= 0 && i < size) return i;
        if (wrap == Wrap::clamp_to_edge) return i < 0 ? 0 : size - 1;
        const int period = wrap == Wrap::repeat ? size : 2 * size;
        i %= period;
        if (i < 0) i += period;
        return i < size ? i : 2 * size - 1 - i;
    }
    [[nodiscard]] glm::vec4 texel(const Entry& entry, int x, int y) const {
        const std::size_t index = static_cast<std::size_t>(wrapped(y, entry.height, entry.wrap_v)) * entry.width +
                                  wrapped(x, entry.width, entry.wrap_u);
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
    std::array<float, 256> srgb_{}, linear_{};
};

}  // namespace heliodon::trace
