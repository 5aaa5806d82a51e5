#pragma once

#include <array>
#include <compare>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "scene/material.h"

namespace heliodon::import {

/// An encoded picture: a file of its own, or bytes inside a model file (which must outlive the decoding).
struct ImageSource {
    std::string where;           ///< stands in messages
    std::filesystem::path file;  ///< empty: `bytes` holds the picture
    std::span<const std::uint8_t> bytes;
};

struct SamplerState {
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    Filter magnify = Filter::linear;
    Filter minify = Filter::linear;
    bool mipmapped = true;
    auto operator<=>(const SamplerState&) const = default;
};

/// Where one channel of a texture comes from; image −1 is the constant 1.
struct ChannelSource {
    int image = -1;
    int channel = 0;
    auto operator<=>(const ChannelSource&) const = default;
};

/// One texture to be made from one or several pictures. Equal recipes are made once.
struct TextureRecipe {
    std::array<ChannelSource, 4> channels;
    ChannelSource opacity;  ///< multiplies the alpha channel
    TextureFormat format = TextureFormat::srgb8;
    SamplerState sampler;
    /// Alpha-tested at this value: mip levels keep the covered area of level 0.
    std::optional<float> alpha_cutoff;
    auto operator<=>(const TextureRecipe&) const = default;
};

/// The whole picture, all four channels.
[[nodiscard]] TextureRecipe whole_image(int image, TextureFormat format, const SamplerState& sampler);
/// The picture's colour with alpha 1.
[[nodiscard]] TextureRecipe opaque_image(int image, TextureFormat format, const SamplerState& sampler);

/// Collects the textures that a model's materials ask for, then makes them all in parallel.
class TextureSet {
public:
    /// The number of a picture; the same file is one picture.
    int add_image(ImageSource source);
    /// The number of a texture; an equal recipe gives an equal number.
    int add(const TextureRecipe& recipe);
    [[nodiscard]] std::size_t size() const { return recipes_.size(); }
    /// Adds texture `index` of another set with its pictures.
    int add_from(const TextureSet& other, int index);
    /// A text that is equal for equal recipes of equal files.
    [[nodiscard]] std::string identity(int index) const;
    /// Decodes and packs every texture, with its mip chain, in the order of their numbers. Throws
    /// ImportFailure for a picture that cannot be read.
    [[nodiscard]] std::vector<Texture> build() const;

private:
    std::vector<ImageSource> images_;
    std::vector<TextureRecipe> recipes_;
};

/// How the alpha of an 8-bit texture is best drawn: opaque where every alpha is 1, masked where nearly all
/// of it is 0 or 1, blended otherwise.
[[nodiscard]] AlphaMode alpha_mode_of(const Texture& texture);

/// Fills levels 1… from level 0 as build_mip_chain does; with a cutoff, the alpha of each level is scaled
/// so that the share of texels above it stays that of level 0.
void build_mip_chain(Texture& texture, std::optional<float> alpha_cutoff);

/// Decodes `source` to four 8-bit channels, rows from the top.
struct DecodedImage {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> texels;
};
[[nodiscard]] DecodedImage decode_image(const ImageSource& source);

}  // namespace heliodon::import
