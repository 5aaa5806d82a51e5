#include "import/texture_set.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "core/image_io.h"
#include "import/import.h"
#include "import/import_failure.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_NO_GIF
#define STBI_NO_PSD
#define STBI_NO_PIC
#define STBI_NO_PNM
#include <stb_image.h>

namespace heliodon::import {
namespace {

/// The largest picture side: what Vulkan devices commonly offer as maxImageDimension2D.
constexpr int largest_side = 16384;

struct StbFree {
    void operator()(stbi_uc* texels) const { stbi_image_free(texels); }
};

/// `image` sampled bilinearly at the size of the texture it is packed into; texel centres, edges clamped.
DecodedImage resample(const DecodedImage& image, int width, int height) {
    DecodedImage result{width, height, std::vector<std::uint8_t>(std::size_t(width) * height * 4)};
    const auto texel = [&](int x, int y, int c) {
        x = std::clamp(x, 0, image.width - 1);
        y = std::clamp(y, 0, image.height - 1);
        return float(image.texels[(std::size_t(y) * image.width + x) * 4 + c]);
    };
    for (int y = 0; y < height; ++y) {
        const float v = (y + 0.5f) * image.height / height - 0.5f;
        const int y0 = int(std::floor(v));
        for (int x = 0; x < width; ++x) {
            const float u = (x + 0.5f) * image.width / width - 0.5f;
            const int x0 = int(std::floor(u));
            for (int c = 0; c < 4; ++c) {
                const float top = std::lerp(texel(x0, y0, c), texel(x0 + 1, y0, c), u - x0);
                const float bottom = std::lerp(texel(x0, y0 + 1, c), texel(x0 + 1, y0 + 1, c), u - x0);
                result.texels[(std::size_t(y) * width + x) * 4 + c] =
                    std::uint8_t(std::lerp(top, bottom, v - y0) + 0.5f);
            }
        }
    }
    return result;
}

/// The pictures that a recipe draws on, each decoded once and all of one size.
struct Ingredients {
    std::vector<int> numbers;
    std::vector<DecodedImage> images;

    [[nodiscard]] const DecodedImage* find(int number) const {
        const auto at = std::find(numbers.begin(), numbers.end(), number);
        return at == numbers.end() ? nullptr : &images[at - numbers.begin()];
    }
};

Ingredients gather(const TextureRecipe& recipe, const std::vector<ImageSource>& sources) {
    Ingredients result;
    const auto need = [&](const ChannelSource& channel) {
        if (channel.image < 0 || result.find(channel.image)) return;
        result.images.push_back(decode_image(sources[channel.image]));
        result.numbers.push_back(channel.image);
    };
    for (const ChannelSource& channel : recipe.channels) need(channel);
    need(recipe.opacity);
    int width = 1, height = 1;
    for (const DecodedImage& image : result.images) {
        width = std::max(width, image.width);
        height = std::max(height, image.height);
    }
    for (DecodedImage& image : result.images)
        if (image.width != width || image.height != height) image = resample(image, width, height);
    return result;
}

bool is_whole_image(const TextureRecipe& recipe) {
    for (int c = 0; c < 4; ++c)
        if (recipe.channels[c] != ChannelSource{recipe.channels[0].image, c}) return false;
    return recipe.channels[0].image >= 0 && recipe.opacity.image < 0;
}

std::vector<std::uint8_t> pack(const TextureRecipe& recipe, Ingredients& ingredients) {
    if (is_whole_image(recipe)) return std::move(ingredients.images[0].texels);
    const std::size_t count = ingredients.images.empty() ? 1 : ingredients.images[0].texels.size() / 4;
    std::vector<std::uint8_t> texels(count * 4, 255);
    for (int c = 0; c < 4; ++c) {
        const DecodedImage* image = ingredients.find(recipe.channels[c].image);
        if (!image) continue;
        for (std::size_t i = 0; i < count; ++i) texels[i * 4 + c] = image->texels[i * 4 + recipe.channels[c].channel];
    }
    if (const DecodedImage* opacity = ingredients.find(recipe.opacity.image))
        for (std::size_t i = 0; i < count; ++i)
            texels[i * 4 + 3] =
                std::uint8_t((texels[i * 4 + 3] * opacity->texels[i * 4 + recipe.opacity.channel] + 127) / 255);
    return texels;
}

Texture make_texture(const TextureRecipe& recipe, const std::vector<ImageSource>& sources) {
    Ingredients ingredients = gather(recipe, sources);
    Texture texture;
    if (!ingredients.numbers.empty()) {
        const ImageSource& source = sources[ingredients.numbers[0]];
        texture.name = source.file.empty() ? source.where : source.file.filename().string();
        texture.width = ingredients.images[0].width;
        texture.height = ingredients.images[0].height;
    } else {
        texture.width = texture.height = 1;
    }
    texture.format = recipe.format;
    texture.wrap_u = recipe.sampler.wrap_u;
    texture.wrap_v = recipe.sampler.wrap_v;
    texture.magnify = recipe.sampler.magnify;
    texture.minify = recipe.sampler.minify;
    texture.mipmapped = recipe.sampler.mipmapped;
    texture.levels.push_back(pack(recipe, ingredients));
    ingredients = {};
    build_mip_chain(texture, recipe.alpha_cutoff);
    return texture;
}

}  // namespace

DecodedImage decode_image(const ImageSource& source) {
    std::string file_bytes;
    std::span<const std::uint8_t> bytes = source.bytes;
    if (!source.file.empty()) {
        Result<std::string> read = read_file(source.file);
        if (!read) throw ImportFailure(read.error());
        file_bytes = std::move(*read);
        bytes = {reinterpret_cast<const std::uint8_t*>(file_bytes.data()), file_bytes.size()};
    }
    int width = 0, height = 0, channels = 0;
    if (bytes.size() > std::size_t(std::numeric_limits<int>::max()))
        refuse(source.where, "expected a picture below 2 GiB");
    const std::string_view encoded(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (const Result<void> sound = check_display_picture(encoded); !sound) refuse(source.where, sound.error().message);
    if (!stbi_info_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels))
        refuse(source.where, fmt::format("expected a picture (PNG, JPEG, TGA or BMP), found {} bytes that are none: {}",
                                         bytes.size(), stbi_failure_reason()));
    if (width > largest_side || height > largest_side)
        refuse(source.where, fmt::format("expected a picture of at most {0} × {0} texels, found {1} × {2}",
                                         largest_side, width, height));
    // PNG packs densest: deflate expands 1032 times at most (RFC 1951), to eight texels a byte. Of the others stb
    // would fill what is missing with black, whatever the size.
    constexpr std::size_t most_texels_a_byte = 8 * 1032;
    if (std::size_t(width) * std::size_t(height) / most_texels_a_byte > bytes.size())
        refuse(source.where, fmt::format("{} × {} texels cannot come from {} bytes", width, height, bytes.size()));
    const std::unique_ptr<stbi_uc, StbFree> texels(
        stbi_load_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels, 4));
    if (!texels) refuse(source.where, fmt::format("the picture is damaged: {}", stbi_failure_reason()));
    return {width, height, std::vector<std::uint8_t>(texels.get(), texels.get() + std::size_t(width) * height * 4)};
}

TextureRecipe whole_image(int image, TextureFormat format, const SamplerState& sampler) {
    TextureRecipe recipe{.format = format, .sampler = sampler};
    for (int c = 0; c < 4; ++c) recipe.channels[c] = {image, c};
    return recipe;
}

TextureRecipe opaque_image(int image, TextureFormat format, const SamplerState& sampler) {
    TextureRecipe recipe = whole_image(image, format, sampler);
    recipe.channels[3] = {};
    return recipe;
}

int TextureSet::add_image(ImageSource source) {
    if (!source.file.empty())
        for (std::size_t i = 0; i < images_.size(); ++i)
            if (images_[i].file == source.file) return int(i);
    images_.push_back(std::move(source));
    return int(images_.size() - 1);
}

int TextureSet::add(const TextureRecipe& recipe) {
    const auto at = std::find(recipes_.begin(), recipes_.end(), recipe);
    if (at != recipes_.end()) return int(at - recipes_.begin());
    recipes_.push_back(recipe);
    return int(recipes_.size() - 1);
}

int TextureSet::add_from(const TextureSet& other, int index) {
    TextureRecipe recipe = other.recipes_[std::size_t(index)];
    const auto bring = [&](ChannelSource& channel) {
        if (channel.image >= 0) channel.image = add_image(other.images_[std::size_t(channel.image)]);
    };
    for (ChannelSource& channel : recipe.channels) bring(channel);
    bring(recipe.opacity);
    return add(recipe);
}

std::string TextureSet::identity(int index) const {
    const TextureRecipe& recipe = recipes_[std::size_t(index)];
    std::string text = fmt::format("{} {} {} {} {} {} {}", int(recipe.format), int(recipe.sampler.wrap_u),
                                   int(recipe.sampler.wrap_v), int(recipe.sampler.magnify), int(recipe.sampler.minify),
                                   recipe.sampler.mipmapped, recipe.alpha_cutoff.value_or(-1.0f));
    const auto append = [&](const ChannelSource& channel) {
        if (channel.image < 0)
            text += "|";
        else
            text += fmt::format("|{}:{}", channel.channel, images_[std::size_t(channel.image)].where);
    };
    for (const ChannelSource& channel : recipe.channels) append(channel);
    append(recipe.opacity);
    return text;
}

std::vector<Texture> TextureSet::build() const {
    std::vector<Texture> textures(recipes_.size());
    tbb::parallel_for(std::size_t(0), recipes_.size(),
                      [&](std::size_t i) { textures[i] = make_texture(recipes_[i], images_); });
    return textures;
}

AlphaMode alpha_mode_of(const Texture& texture) {
    if (texture.opaque || texture.levels.empty()) return AlphaMode::opaque;
    // Anti-aliased edges of a cut-out are few and lie between; a tenth of the texels leaves room for them.
    constexpr int nearly = 16;
    constexpr std::size_t edge_share = 10;
    std::size_t between = 0;
    const std::vector<std::uint8_t>& texels = texture.levels[0];
    for (std::size_t i = 3; i < texels.size(); i += 4) between += texels[i] >= nearly && texels[i] <= 255 - nearly;
    return between * edge_share <= texels.size() / 4 ? AlphaMode::mask : AlphaMode::blend;
}

}  // namespace heliodon::import

namespace heliodon {

Result<Texture> load_texture(const std::filesystem::path& path, TextureFormat format) {
    return import::guarded(path, [&] {
        if (format == TextureFormat::float32) {
            Result<Picture> picture = read_picture(path);
            if (!picture) throw import::ImportFailure(picture.error());
            const Image& image = picture->image;
            Texture texture{.name = path.filename().string(), .width = image.width, .height = image.height};
            texture.format = format;
            std::vector<std::uint8_t> level(std::size_t(image.width) * image.height * texture.bytes_per_texel());
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x) {
                    const glm::vec4 texel(image.rgb(x, y), image.channels == 4 ? image.at(x, y, 3) : 1.0f);
                    std::memcpy(&level[(std::size_t(y) * image.width + x) * sizeof texel], &texel, sizeof texel);
                }
            picture->image = {};
            texture.levels.push_back(std::move(level));
            build_mip_chain(texture);
            return texture;
        }
        import::TextureSet set;
        const int image = set.add_image({.where = path.string(), .file = path, .bytes = {}});
        set.add(import::whole_image(image, format, {}));
        return std::move(set.build()[0]);
    });
}

void build_mip_chain(Texture& texture) {
    import::build_mip_chain(texture, std::nullopt);
}

}  // namespace heliodon
