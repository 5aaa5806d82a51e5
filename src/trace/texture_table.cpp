#include "trace/texture_table.h"

#include <algorithm>

#include "core/units.h"

namespace heliodon::trace {

void TextureTable::update(const convert::FlatScene& flat) {
    for (int byte = 0; byte < 256; ++byte) {
        linear_[byte] = static_cast<float>(byte) / 255.0f;
        srgb_[byte] = units::srgb_decode(linear_[byte]);
    }
    entries_.assign(flat.textures().size(), {});
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Texture* texture = flat.textures()[i];
        if (!texture || texture->levels.empty()) continue;
        const std::uint32_t level = std::min<std::uint32_t>(flat.texture_first_levels()[i], texture->levels.size() - 1);
        Entry entry;
        entry.width = std::max(1, texture->width >> level);
        entry.height = std::max(1, texture->height >> level);
        entry.format = texture->format;
        entry.wrap_u = texture->wrap_u;
        entry.wrap_v = texture->wrap_v;
        entry.nearest = texture->magnify == Filter::nearest;
        const std::size_t needed = static_cast<std::size_t>(entry.width) * entry.height * texture->bytes_per_texel();
        if (texture->levels[level].size() >= needed) entry.texels = texture->levels[level].data();
        entries_[i] = entry;
    }
    static constexpr std::uint8_t white[4] = {255, 255, 255, 255};
    whole_ = entries_;
    whole_.emplace_back();
    for (Entry& entry : whole_)
        if (!entry.texels) entry = {.texels = white};
}

}  // namespace heliodon::trace
