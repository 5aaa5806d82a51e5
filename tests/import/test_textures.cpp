#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "core/image_io.h"
#include "import/glb_builder.h"
#include "import/picture_files.h"
#include "import/texture_set.h"

namespace heliodon {
namespace {

Texture texture_of(int width, int height, TextureFormat format, std::vector<std::uint8_t> texels) {
    Texture texture;
    texture.width = width;
    texture.height = height;
    texture.format = format;
    texture.levels = {std::move(texels)};
    return texture;
}

double to_linear(int byte) {
    const double e = byte / 255.0;
    return e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
}

TEST(Textures, ColourIsFilteredInLinearLight) {
    Texture texture = texture_of(2, 1, TextureFormat::srgb8, {0, 0, 0, 255, 255, 255, 255, 255});
    build_mip_chain(texture);
    ASSERT_EQ(texture.levels.size(), 2u);
    EXPECT_EQ(texture.levels[1][0], 188) << "half of white's light, not half of its byte";
    EXPECT_TRUE(texture.opaque);
}

TEST(Textures, DataIsFilteredAsItIs) {
    Texture texture = texture_of(2, 1, TextureFormat::linear8, {0, 0, 0, 255, 254, 100, 50, 255});
    build_mip_chain(texture);
    EXPECT_EQ(texture.levels[1], (std::vector<std::uint8_t>{127, 50, 25, 255}));
}

TEST(Textures, ConstantTexturesStayConstantAtEveryLevel) {
    for (int byte = 0; byte < 256; ++byte) {
        std::vector<std::uint8_t> texels;
        for (int i = 0; i < 15; ++i)
            texels.insert(texels.end(), {std::uint8_t(byte), std::uint8_t(byte), std::uint8_t(byte), 255});
        Texture texture = texture_of(5, 3, TextureFormat::srgb8, texels);
        build_mip_chain(texture);
        for (const auto& level : texture.levels) EXPECT_EQ(level[0], byte);
    }
}

TEST(Textures, OddSizesKeepTheirMean) {
    for (const auto& [width, height] : {std::pair{5, 3}, {7, 7}, {1, 9}, {33, 2}, {101, 57}}) {
        Texture texture = texture_of(width, height, TextureFormat::float32, {});
        std::vector<glm::vec4> texels(std::size_t(width) * height);
        std::mt19937 random(1);
        glm::dvec4 mean(0);
        for (glm::vec4& texel : texels) {
            texel = glm::vec4(random() % 1000, random() % 1000, random() % 1000, 1);
            mean += glm::dvec4(texel) / double(texels.size());
        }
        texture.levels[0].resize(texels.size() * sizeof(glm::vec4));
        std::memcpy(texture.levels[0].data(), texels.data(), texture.levels[0].size());
        build_mip_chain(texture);
        int levels = 1;
        for (int size = std::max(width, height); size > 1; size /= 2) ++levels;
        ASSERT_EQ(int(texture.levels.size()), levels);
        for (int k = 0; k < levels; ++k)
            EXPECT_EQ(texture.levels[std::size_t(k)].size(),
                      std::size_t(std::max(1, width >> k)) * std::max(1, height >> k) * 16);
        glm::vec4 last;
        std::memcpy(&last, texture.levels.back().data(), sizeof last);
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(last[c], mean[c], 1e-3 * mean[c]);
    }
}

TEST(Textures, InvisibleTexelsDoNotBleedTheirColour) {
    Texture texture = texture_of(2, 1, TextureFormat::srgb8, {200, 100, 50, 255, 0, 255, 0, 0});
    build_mip_chain(texture);
    EXPECT_EQ(texture.levels[1], (std::vector<std::uint8_t>{200, 100, 50, 128}));
    EXPECT_FALSE(texture.opaque);
}

TEST(Textures, MaskedTexturesKeepTheirCoveredArea) {
    constexpr int size = 64;
    std::vector<std::uint8_t> texels;
    std::mt19937 random(5);
    for (int i = 0; i < size * size; ++i)
        texels.insert(texels.end(), {90, 120, 40, std::uint8_t(random() % 5 == 0 ? 255 : 0)});
    const auto covered = [](const std::vector<std::uint8_t>& level) {
        std::size_t above = 0;
        for (std::size_t i = 3; i < level.size(); i += 4) above += level[i] >= 128;
        return double(above) / double(level.size() / 4);
    };
    Texture plain = texture_of(size, size, TextureFormat::srgb8, texels), masked = plain;
    build_mip_chain(plain);
    import::build_mip_chain(masked, 0.5f);
    EXPECT_LT(covered(plain.levels[2]), 0.05) << "filtered alpha alone thins leaves out";
    for (std::size_t level = 1; level < 4; ++level)
        EXPECT_NEAR(covered(masked.levels[level]), covered(masked.levels[0]), 0.06) << level;
}

TEST(Textures, UnmippedTexturesHaveOneLevel) {
    Texture texture = texture_of(4, 4, TextureFormat::linear8, std::vector<std::uint8_t>(64, 3));
    texture.mipmapped = false;
    build_mip_chain(texture);
    EXPECT_EQ(texture.levels.size(), 1u);
}

TEST(Textures, FilesLoadWithTheirChain) {
    const tests::TemporaryFolder folder;
    const auto path = folder.write("grey.png", tests::png(4, 2, 1, {0, 50, 100, 150, 200, 250, 255, 9}));
    const auto texture = load_texture(path, TextureFormat::srgb8);
    ASSERT_TRUE(texture) << texture.error().text();
    EXPECT_EQ(texture->width, 4);
    EXPECT_EQ(texture->height, 2);
    EXPECT_EQ(texture->levels.size(), 3u);
    EXPECT_EQ(texture->levels[0][4], 50);
    EXPECT_EQ(texture->levels[0][5], 50);
    double mean = 0;
    for (const int byte : {0, 50, 100, 150, 200, 250, 255, 9}) mean += to_linear(byte) / 8;
    EXPECT_NEAR(to_linear(texture->levels[2][0]), mean, 0.005);
}

TEST(Textures, HdrPicturesLoadAsFloats) {
    const tests::TemporaryFolder folder;
    Picture picture;
    picture.image = Image(4, 2, 3);
    picture.image.at(1, 0, 0) = 20000;
    ASSERT_TRUE(write_picture(folder / "sky.exr", picture));
    const auto texture = load_texture(folder / "sky.exr", TextureFormat::float32);
    ASSERT_TRUE(texture) << texture.error().text();
    glm::vec4 texel;
    std::memcpy(&texel, &texture->levels[0][16], sizeof texel);
    EXPECT_EQ(texel, glm::vec4(20000, 0, 0, 1));
    std::memcpy(&texel, texture->levels[2].data(), sizeof texel);
    EXPECT_EQ(texel.x, 2500);
}

TEST(Textures, UnreadableFilesAreLocated) {
    const tests::TemporaryFolder folder;
    const auto missing = load_texture(folder / "gone.png", TextureFormat::srgb8);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().text().find("gone.png"), std::string::npos);
    const auto garbage = load_texture(folder.write("text.png", "hello"), TextureFormat::srgb8);
    ASSERT_FALSE(garbage);
    EXPECT_NE(garbage.error().text().find("text.png"), std::string::npos);
    EXPECT_NE(garbage.error().message.find("expected a picture"), std::string::npos);
}

TEST(Textures, PicturesThatSayMoreThanTheirBytesHoldAreRefused) {
    const tests::TemporaryFolder folder;
    // A BMP's headers, 16384 × 16384 texels of 24 bits, and not one of them.
    std::string bmp("BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\0\x40\0\0\0\x40\0\0\1\0\x18\0", 30);
    bmp.resize(54, '\0');
    const auto texture = load_texture(folder.write("huge.bmp", bmp), TextureFormat::srgb8);
    ASSERT_FALSE(texture);
    EXPECT_NE(texture.error().text().find("huge.bmp: 16384 × 16384 texels cannot come from 54 bytes"),
              std::string::npos)
        << texture.error().text();
}

TEST(Textures, AlphaTellsMasksFromGlass) {
    const auto with_alpha = [](std::uint8_t alpha) {
        Texture texture = texture_of(4, 1, TextureFormat::srgb8, std::vector<std::uint8_t>(16, 255));
        texture.levels[0][3] = alpha;
        build_mip_chain(texture);
        return import::alpha_mode_of(texture);
    };
    EXPECT_EQ(with_alpha(255), AlphaMode::opaque);
    EXPECT_EQ(with_alpha(0), AlphaMode::mask);
    EXPECT_EQ(with_alpha(100), AlphaMode::blend);
}

}  // namespace
}  // namespace heliodon
